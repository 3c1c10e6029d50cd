#!/usr/bin/env bash
# Diagnoses measured recordings of other teams, which stand beside this repository, by the scenarios of scenarios/real.
#
#   bash tests/real/run.sh SOFTDOCK_BINARY RECORDINGS OUT        RECORDINGS holds <name>/*.csv; SKIPPED where it does not
set -euo pipefail
[[ $# == 3 ]] || { echo "usage: $0 SOFTDOCK_BINARY RECORDINGS OUT" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
softdock=$(realpath -e -- "$1") recordings=$2 out=$3
for manifest in "$here"/*/recording.toml; do
  name=$(basename "$(dirname "$manifest")")
  if [[ ! -d $recordings/$name ]]; then echo "$name: its recording is not at hand: SKIPPED"; continue; fi
  mkdir -p "$out/$name/recording"
  cp "$manifest" "$recordings/$name"/*.csv "$out/$name/recording/"
  "$softdock" diagnose "$here/../../scenarios/real/$name.toml" "$out/$name/recording" --out "$out/$name/out" >"$out/$name/log" 2>&1 || true
  echo "== $name"
  sed -n '1,40p' "$out/$name/log"
done

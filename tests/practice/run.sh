#!/usr/bin/env bash
# Diagnoses every set of recordings in a folder, says how long each took and how much memory, and judges all against keys.
#
#   run.sh SOFTDOCK_BINARY RECORDINGS KEYS OUT [SET…]
#
# RECORDINGS holds one folder a set, named after its rig (tumbler-02 → scenarios/rigs/tumbler.toml); `diagnose` never sees KEYS.
set -euo pipefail
[[ $# -ge 4 ]] || { echo "usage: $0 SOFTDOCK_BINARY RECORDINGS KEYS OUT [SET…]" >&2; exit 2; }
softdock=$(realpath -e -- "$1") recordings=$(realpath -e -- "$2") keys=$(realpath -e -- "$3") out=$4
shift 4
rigs=$(cd "$(dirname "$0")/../../scenarios/rigs" && pwd)
mkdir -p "$out"
sets=("$@")
if [[ ${#sets[@]} == 0 ]]; then
  for folder in "$recordings"/*/recording.toml; do sets+=("$(basename "$(dirname "$folder")")"); done
fi

printf '| set | verdict | s | MiB |\n| --- | --- | --- | --- |\n'
for set in "${sets[@]}"; do
  rig=${set%-*}
  [[ -f $rigs/$rig.toml ]] || { echo "SKIPPED: $set has no scenario $rigs/$rig.toml" >&2; continue; }
  from=$(date +%s)
  peak=0
  "$softdock" diagnose "$rigs/$rig.toml" "$recordings/$set" --out "$out/$set" --quiet >"$out/$set.log" 2>&1 &
  process=$!
  # The kernel keeps the peak for us; the last look before the end is near enough.
  while kill -0 "$process" 2>/dev/null; do
    now=$(awk '/^VmHWM/ {print int($2 / 1024)}' "/proc/$process/status" 2>/dev/null || echo 0)
    [[ -n $now && $now -gt $peak ]] && peak=$now
    sleep 0.5
  done
  wait "$process" && status=0 || status=$?
  verdict=$(sed -n 's/^  "verdict": "\(.*\)",*$/\1/p' "$out/$set/diagnosis.json" 2>/dev/null || true)
  printf '| %s | %s | %d | %d |\n' "$set" "${verdict:-failed ($status), see $out/$set.log}" "$(($(date +%s) - from))" "$peak"
done
"$softdock" score "$out" "$keys" --markdown --present

#!/usr/bin/env bash
# Another simulator's recordings: MuJoCo moves two robots with something concealed, softdock diagnoses them, and the answers are judged.
#
#   bash tests/mujoco/run.sh SOFTDOCK_BINARY OUT        SKIPPED without mujoco 4.0 and numpy (PyPI) for python3
set -euo pipefail
[[ $# == 2 ]] || { echo "usage: $0 SOFTDOCK_BINARY OUT" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
softdock=$(realpath -e -- "$1") out=$2
python3 -c 'import mujoco, numpy' 2>/dev/null || { echo "mujoco or numpy is not installed: SKIPPED (pip install mujoco==4.0.0 numpy)"; exit 0; }
[[ -f $out/keys.json ]] || python3 "$here/record.py" "$out"
for recording in "$out"/*/*/recording.toml; do
  case=$(dirname "$recording")
  "$softdock" diagnose "$(dirname "$case")/scenario.toml" "$case" --out "$case/out" --quiet >"$case.log" 2>&1 || true
done
python3 "$here/check.py" "$out"

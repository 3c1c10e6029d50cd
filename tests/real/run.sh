#!/usr/bin/env bash
# Diagnoses measured recordings of other teams, which stand beside this repository, by the scenarios of scenarios/real.
#
#   bash tests/real/run.sh SOFTDOCK_BINARY RECORDINGS OUT        RECORDINGS holds <rig>/*.csv; SKIPPED where it does not
#
# A folder here is a rig, or a rig and a choice of its files: <rig>--<choice>.
set -euo pipefail
[[ $# == 3 ]] || { echo "usage: $0 SOFTDOCK_BINARY RECORDINGS OUT" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
softdock=$(realpath -e -- "$1") recordings=$2 out=$3
for manifest in "$here"/*/recording.toml; do
  name=$(basename "$(dirname "$manifest")")
  rig=${name%%--*}
  if [[ ! -d $recordings/$rig ]]; then echo "$name: its recording is not at hand: SKIPPED"; continue; fi
  mkdir -p "$out/$name/recording"
  cp "$manifest" "$recordings/$rig"/*.csv "$out/$name/recording/"
  "$softdock" diagnose "$here/../../scenarios/real/$rig.toml" "$out/$name/recording" --out "$out/$name/out" >"$out/$name/log" 2>&1 || true
  echo "== $name"
  sed -n '1,40p' "$out/$name/log"
  [[ -f $here/$name/published.toml ]] || continue
  # What the authors' own numbers leave, in the same windows of the same runs: the error of a scenario that has them.
  sed "s#\"\.\./\.\./robots#\"$here/../../robots#" "$here/../../scenarios/real/$rig.toml" |
    cat - "$here/$name/published.toml" >"$out/$name/published.toml"
  "$softdock" diagnose "$out/$name/published.toml" "$out/$name/recording" --out "$out/$name/beside" --quiet >/dev/null 2>&1 || true
  python3 - "$out/$name/out/diagnosis.json" "$out/$name/beside/diagnosis.json" <<'EOF'
import json, sys
found, published = (json.load(open(f))["error"] for f in sys.argv[1:])
print(f"windows of {found['window_s']:.3g} s, runs left out: nominal {found['windowed']['before']:.4g}, found {found['windowed']['after']:.4g}", end="")
same = abs(found["window_s"] - published["window_s"]) < 1e-9
print(f", published {published['windowed']['before']:.4g} times the noise" if same else "; published: judged in other windows")
EOF
done

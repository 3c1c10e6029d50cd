#!/usr/bin/env bash
# How long from a fresh clone to the first capture, and where the time goes: clones this repository, builds into an empty target folder
# (sources of dependencies are fetched before the clock starts), runs the README's first command, and lists what took longest to compile.
#
#   bash tests/first-minute/run.sh [FOLDER]      the folder is made, and removed when all went well
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)
folder=${1:-$(mktemp -d)}
git clone --quiet "$repository" "$folder/softdock"
cd "$folder/softdock"
command=$(awk '/^## Run/ {found = 1} found && /^    cargo run/ {sub(/^ +/, ""); print; exit}' README.md)
echo "first command: $command"
cargo fetch --locked --quiet
seconds() { date +%s.%N; }
start=$(seconds)
# `--timings` changes nothing of what is built.
bash -c "time cargo build --quiet --bin softdock --timings" 2> "$folder/times"
built=$(seconds)
$command --quiet | tail -1 || true
end=$(seconds)
grep -q '"outcome": "captured"' out/capture/summary.json
python3 - "$start" "$built" "$end" "$folder/times" <<'PYTHON'
import glob, json, re, sys
start, built, end = map(float, sys.argv[1:4])
cpu = sum(float(m) * 60 + float(s) for m, s in re.findall(r"(?:user|sys)\s+(\d+)m([\d.]+)s", open(sys.argv[4]).read()))
print(f"captured after {(end - start) / 60:.1f} min: {(built - start) / 60:.1f} min to build ({cpu / 60:.1f} min of one core), {end - built:.1f} s to run")
page = open(sorted(glob.glob("target/cargo-timings/cargo-timing-*.html"))[-1]).read()
units = json.loads(re.search(r"const UNIT_DATA = (\[.*?\]);", page, re.S).group(1))
total = sum(u["duration"] for u in units)
own = sum(u["duration"] for u in units if u["name"].startswith("softdock"))
print(f"{len(units)} units, {total:.0f} s in all, of it {own:.0f} s for softdock's own crates; the longest:")
for u in sorted(units, key=lambda u: -u["duration"])[:15]:
    print(f"  {u['duration']:6.1f} s  {u['name']} {u['version']}")
PYTHON
rm -rf "$folder"

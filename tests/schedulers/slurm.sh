#!/usr/bin/env bash
# Runs a campaign as a job array under a real SLURM of one node, and demands the very table that
# the same campaign gives without SLURM.
#
#   slurm.sh SOFTDOCK_BINARY SCENARIO RUNS SHARDS
#
# Needs root; installs slurm-wlm and munge with apt-get if they are missing. The SLURM is its own:
# temporary folder, configuration, key and ports, so one already running is not disturbed.
# Exit 0: identical, or skipped (the output says SKIPPED). Anything else: failure.
set -euo pipefail

if [ $# -ne 4 ]; then
    echo "usage: $0 SOFTDOCK_BINARY SCENARIO RUNS SHARDS" >&2
    exit 2
fi
softdock=$(realpath -e -- "$1")
scenario=$(realpath -e -- "$2")
runs=$3
shards=$4
start_limit=60 # seconds for the daemons to come up
job_limit=900  # seconds for one array

export PATH="$PATH:/usr/sbin:/sbin"
export LC_ALL=C
# Called from inside a SLURM job or a pod, the test must not take up their shard or defaults.
for variable in "${!SLURM_@}" "${!SBATCH_@}" "${!SOFTDOCK_@}" JOB_COMPLETION_INDEX; do
    unset "$variable"
done

skip() {
    echo "SKIPPED: $*"
    echo "SKIPPED: the SLURM test did NOT run: $*" >&2
    exit 0
}

have_slurm() {
    local tool
    for tool in munged slurmctld slurmd sbatch sinfo; do
        command -v "$tool" >/dev/null || return 1
    done
}

# Packages must not start their services: those are the machine's, and ours are private.
install_slurm() {
    local policy=/usr/sbin/policy-rc.d ours='' status=0
    if [ ! -e "$policy" ]; then
        ours=$policy
        printf '#!/bin/sh\nexit 101\n' >"$policy"
        chmod 755 "$policy"
    fi
    apt-get -o DPkg::Lock::Timeout=300 update &&
        DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 \
            install -y --no-install-recommends slurm-wlm munge || status=$?
    if [ -n "$ours" ]; then
        rm -f "$ours"
    fi
    return "$status"
}

[ "$(id -u)" -eq 0 ] || skip "not root"
if ! have_slurm; then
    command -v apt-get >/dev/null || skip "SLURM is not installed and there is no apt-get"
    install_slurm >&2 || skip "apt-get cannot install slurm-wlm and munge"
    have_slurm || skip "slurm-wlm and munge lack a program"
fi
host=$(uname -n)
host=${host%%.*}
[[ $host =~ ^[A-Za-z0-9_-]+$ ]] || skip "SLURM cannot use the host name '$host'"

# SLURM's own paths must be free of spaces; those of the campaign below are not, on purpose.
dir=$(mktemp -d /tmp/softdock-slurm.XXXXXX)
daemons=()

# shellcheck disable=SC2317  # called by the trap
clean_up() {
    local status=$? pid i
    trap - EXIT INT TERM
    set +e
    if [ "$status" -ne 0 ]; then
        tail -n 5 -- "$dir"/log/*.out >&2
        tail -n 30 -- "$dir"/log/*.log "$dir"/jobs*/*.log >&2
        timeout 10 sinfo -N -l >&2
        timeout 10 squeue -r -t all -o '%i %T %r' >&2
    fi
    # Tasks first: they outlive slurmd.
    timeout 10 scancel --user=root
    for ((i = 0; i < 20; i++)); do
        [ -n "$(timeout 10 squeue -h 2>&1)" ] || break
        sleep 0.5
    done
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do
        pid=${daemons[i]}
        kill "$pid"
        (sleep 10 && kill -9 "$pid") 2>/dev/null &
        wait "$pid"
        kill $!
    done 2>/dev/null
    # Whatever still runs under this folder's configuration is a task of ours.
    while IFS=/ read -r _ _ pid _; do
        kill -9 "$pid" 2>/dev/null
    done < <(grep -lsF "SLURM_CONF=$dir/" /proc/[0-9]*/environ)
    rm -rf -- "$dir"
    exit "$status"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# A port below the usual ephemeral range on which nobody answers.
free_port() {
    local port
    while :; do
        port=$((20000 + RANDOM % 12000))
        if ! (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
            echo "$port"
            return
        fi
    done
}

mkdir "$dir"/{state,spool,log,cgroup}
chmod 711 "$dir" # munge wants to reach its socket through open folders
(umask 077 && head -c 1024 /dev/urandom >"$dir/munge.key")

ctld_port=$(free_port)
slurmd_port=$ctld_port
while [ "$slurmd_port" = "$ctld_port" ]; do
    slurmd_port=$(free_port)
done
memory_mb=$(awk '/^MemTotal:/ { print int($2 / 1024) }' /proc/meminfo)

# config_overrides: take the node as written here, whatever a container shows of the machine.
cat >"$dir/slurm.conf" <<END
ClusterName=softdock
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
SlurmctldPort=$ctld_port
SlurmdPort=$slurmd_port
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SlurmdParameters=config_overrides
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory_mb State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
END

# slurmd loads the cgroup plugin even if nothing uses it, and the one for cgroup v2 insists on
# systemd. "disabled" is documented from 24.05 on; before, the plugin for v1 is content with an
# empty folder.
version=$(slurmd -V | grep -oE '[0-9]+\.[0-9]+' | head -n 1)
if printf '24.05\n%s\n' "$version" | sort -C -V; then
    echo "CgroupPlugin=disabled" >"$dir/cgroup.conf"
else
    printf 'CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s\n' "$dir/cgroup" >"$dir/cgroup.conf"
fi
export SLURM_CONF="$dir/slurm.conf"

# Kept in the foreground of a background job, a daemon's process number is known for certain.
munged --foreground --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" \
    --pid-file="$dir/munged.pid" --log-file="$dir/log/munged.log" --seed-file="$dir/munge.seed" \
    >"$dir/log/munged.out" 2>&1 &
daemons+=($!)
for ((i = 0; i < start_limit * 5; i++)); do
    [ ! -S "$dir/munge.socket" ] || break
    sleep 0.2
done
slurmctld -D >"$dir/log/slurmctld.out" 2>&1 &
daemons+=($!)
slurmd -D >"$dir/log/slurmd.out" 2>&1 &
daemons+=($!)

idle() {
    [ "$(timeout 5 sinfo -h -o %T 2>/dev/null)" = idle ]
}
for ((i = 0; i < start_limit * 2; i++)); do
    ! idle || break
    for pid in "${daemons[@]}"; do
        kill -0 "$pid" 2>/dev/null || {
            echo "FAILED: a SLURM daemon died" >&2
            exit 1
        }
    done
    sleep 0.5
done
idle || {
    echo "FAILED: the SLURM node is not idle after $start_limit s" >&2
    exit 1
}
echo "SLURM $version runs on $host with $(nproc) CPUs"

# Submits from a folder of its own (that is where the logs go) and waits for the array to end.
# In the background, since a trap has to wait for what runs in the foreground.
submit() {
    (cd "$dir/jobs here" && exec timeout "$job_limit" sbatch --wait "$@") &
    wait $! || {
        echo "FAILED: sbatch $*" >&2
        return 1
    }
}

same() {
    cmp -- "$1/table.parquet" "$dir/alone/table.parquet" || {
        echo "FAILED: $2 gives another table than the campaign without SLURM" >&2
        return 1
    }
    echo "identical: $2"
}

mkdir "$dir/jobs here"
"$softdock" campaign "$scenario" --runs "$runs" --out "$dir/alone"

# The emitted script, with a path that only good quoting survives.
out="$dir/it's \$a shard"
script="$dir/campaign.sbatch"
"$softdock" campaign "$scenario" --runs "$runs" --out "$out" \
    --emit slurm --shards "$shards" --threads 1 >"$script"
bash -n "$script"
submit "$script"
"$softdock" merge "$out"/shard-*-of-"$shards" --out "$out/merged"
same "$out/merged" "the emitted script"

# One shard lost: that task alone submitted again, and the script's own merge after it.
rm -r -- "${out:?}/shard-0-of-$shards" "${out:?}/merged"
id=$(cd "$dir/jobs here" && sbatch --parsable --array=0 "$script")
submit --dependency=afterok:"$id" --kill-on-invalid-dep=yes --array=0 "$script" merge
same "$out/merged" "a shard done again, then the script's merge"

# No --shard: the command reads SLURM's variables, here of an array that starts at 3 by steps of 2.
out="$dir/by variables"
{
    echo '#!/bin/bash'
    printf 'exec %q campaign %q --runs %q --out %q\n' "$softdock" "$scenario" "$runs" "$out"
} >"$dir/variables.sbatch"
submit --array="3-$((2 * shards + 1)):2" --cpus-per-task=1 "$dir/variables.sbatch"
"$softdock" merge "$out"/shard-*-of-"$shards" --out "$out/merged"
same "$out/merged" "an array read from SLURM's variables"

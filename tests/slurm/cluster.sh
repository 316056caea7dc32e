#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A one-node Slurm on loopback, for tests: cluster.sh start DIR | stop DIR. Needs root, slurm-wlm and
# munge. Everything lies in DIR; every daemon is ended by the pid it wrote there.
set -euo pipefail
action=$1
dir=$2

write_configuration() {
    local cpus memory
    cpus=$(nproc)
    memory=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 1024 - 500))
    # Ports of its own, so that two of these can stand beside each other.
    local port=$((20000 + $$ % 20000))
    cat >"$dir/slurm.conf" <<END
ClusterName=bench
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$dir/munge/munge.socket.2
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.log
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
MailProg=/bin/true
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$dir/log/jobcomp.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerCPU=500
KillWait=5
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=2,bf_interval=2,batch_sched_delay=0,sched_min_interval=100000
MaxArraySize=10001
MinJobAge=3600
ReturnToService=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$cpus Boards=1 SocketsPerBoard=1 CoresPerSocket=$cpus ThreadsPerCore=1 RealMemory=$memory State=UNKNOWN
PartitionName=bench Nodes=localhost Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
END
}

start_munge() {
    mkdir -p "$dir/munge"
    head -c 128 /dev/urandom >"$dir/munge/munge.key"
    chmod 0400 "$dir/munge/munge.key"
    chown -R munge "$dir/munge"
    chmod 0755 "$dir/munge"
    runuser -u munge -- munged --force --key-file="$dir/munge/munge.key" \
        --socket="$dir/munge/munge.socket.2" --pid-file="$dir/munge/munged.pid" \
        --log-file="$dir/munge/munged.log" --seed-file="$dir/munge/munged.seed"
}

wait_until_idle() {
    export SLURM_CONF=$dir/slurm.conf
    for _ in $(seq 300); do
        sinfo -h -o %t 2>/dev/null | grep -q idle && return 0
        sleep 0.2
    done
    tail -n 20 "$dir"/log/slurm*.log >&2
    return 1
}

case $action in
start)
    chmod 0755 "$dir"
    mkdir -p "$dir/log" "$dir/state" "$dir/spool"
    write_configuration
    start_munge
    SLURM_CONF=$dir/slurm.conf slurmctld -f "$dir/slurm.conf" -c
    SLURM_CONF=$dir/slurm.conf slurmd -f "$dir/slurm.conf" -N localhost
    wait_until_idle
    ;;
stop)
    for file in "$dir/slurmd.pid" "$dir/slurmctld.pid" "$dir/munge/munged.pid"; do
        [ -s "$file" ] || continue
        pid=$(cat "$file")
        # Not asked to: slurmctld takes five seconds to save what nobody will read.
        kill -KILL "$pid" 2>/dev/null || true
        for _ in $(seq 50); do
            kill -0 "$pid" 2>/dev/null || break
            sleep 0.1
        done
    done
    ;;
esac

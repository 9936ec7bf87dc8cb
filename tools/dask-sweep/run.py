#!/usr/bin/env python3
"""Measures a sweep's file on the workers of a Dask cluster, a shard a task, and merges what they wrote.

    pip install -r tools/dask-sweep/requirements.txt
    tools/dask-sweep/run.py sweep.toml -o out --shards 16 --scheduler tcp://head:8786
    tools/dask-sweep/run.py sweep.toml -o out --shards 6 --workers 3        # on this machine alone

Workers see the same folder OUT. A shard whose worker was lost goes to another one, which measures only the rows that
are not on disk yet. The command may be given again: it goes on.
"""

import argparse
import pathlib
import subprocess
import sys

from distributed import Client, LocalCluster, as_completed

# How often a shard whose program was ended by a signal is begun again. Workers that are lost are counted by Dask itself
# (distributed.scheduler.allowed-failures).
RETRIES = 5


def measure(program, sweep, folder, shard, shards):
    """Measures a shard: its number, its exit code, and what it said on standard error."""
    command = [program, "bench", "run", sweep, "--shard", f"{shard}/{shards}", "-o", folder, "--resume", "--quiet"]
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if ended.returncode < 0:
        raise RuntimeError(f"shard {shard} was ended by signal {-ended.returncode}")
    return shard, ended.returncode, ended.stderr


def row_folders(shards):
    """Folders with rows below a shard's, by their path in it: one, or one a scene."""
    found = {}
    for shard in shards:
        for rows in sorted(shard.glob("**/rows.jsonl")):
            found.setdefault(rows.parent.relative_to(shard), []).append(rows.parent)
    return found


def main():
    """Runs the shards and merges them; the exit code is 1 where a shard failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sweep", help="the file of `quincunx bench run`")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder that all workers see")
    parser.add_argument("--shards", type=int, required=True, help="parts of the rows; several a worker even them out")
    parser.add_argument("--program", default="quincunx", help="the program on the workers")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--scheduler", help="address of a scheduler")
    where.add_argument("--workers", type=int, help="workers on this machine, each of which measures one shard at a time")
    asked = parser.parse_args()

    if asked.shards < 1 or (asked.workers is not None and asked.workers < 1):
        parser.error("--shards and --workers are at least 1")
    output = asked.output.resolve()
    shards = [output / "shards" / str(number) for number in range(1, asked.shards + 1)]
    for shard in shards:
        shard.mkdir(parents=True, exist_ok=True)
    sweep = str(pathlib.Path(asked.sweep).resolve())
    cluster = None
    if asked.workers is not None:
        # A worker is a process: times of shards beside each other on one machine are for trying, not for quoting.
        cluster = LocalCluster(n_workers=asked.workers, threads_per_worker=1, dashboard_address=None)
    failed = 0
    with Client(cluster or asked.scheduler) as client:
        tasks = [
            client.submit(measure, asked.program, sweep, str(folder), number, asked.shards, retries=RETRIES, pure=False)
            for number, folder in enumerate(shards, 1)
        ]
        for done, task in enumerate(as_completed(tasks), 1):
            if task.exception() is not None:
                failed += 1
                print(f"{done} of {len(tasks)} shards: {task.exception()}", file=sys.stderr)
                continue
            shard, code, said = task.result()
            failed += code != 0
            print(f"{done} of {len(tasks)} shards: shard {shard} ended with {code}", file=sys.stderr)
            if code != 0:
                print(said, end="", file=sys.stderr)
    if cluster:
        cluster.close()
    for path, folders in row_folders(shards).items():
        command = [asked.program, "bench", "merge", *map(str, folders), "-o", str(output / "all" / path), "--force"]
        failed += subprocess.run(command, check=False).returncode != 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

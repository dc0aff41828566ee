#!/usr/bin/python3
"""Says to snakemake how a job of Slurm is: running, success or failed.

Asks the controller, which forgets jobs some minutes after their end, and then the accounting where there is
one. A job that neither knows has failed; a controller that does not answer says nothing of a job, which then
counts as running.
"""
import re
import subprocess
import sys
import time

GOOD = {'COMPLETED'}
GOING = {'PENDING', 'CONFIGURING', 'RUNNING', 'COMPLETING', 'SUSPENDED', 'REQUEUED', 'RESIZING', 'STAGE_OUT',
         'SIGNALING', 'REQUEUE_HOLD', 'REQUEUE_FED', 'SPECIAL_EXIT', 'STOPPED', 'RESV_DEL_HOLD'}
ATTEMPTS = 5


def asked(*words):
    try:
        ran = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding='utf-8', timeout=30)
    except (OSError, subprocess.TimeoutExpired) as error:
        return 1, '', str(error)
    return ran.returncode, ran.stdout, ran.stderr


def state_of(job):
    """The state of a job in Slurm's words; '' where none knows it, None where none answers."""
    for attempt in range(ATTEMPTS):
        status, out, problem = asked('scontrol', '--oneliner', 'show', 'job', job)
        if status == 0:
            found = re.search(r'\bJobState=(\w+)', out)
            return found.group(1) if found else ''
        if 'Invalid job id' in problem:
            status, out, _ = asked('sacct', '--noheader', '--parsable2', '--allocations', '--format=State',
                                   '--jobs', job)
            return out.split()[0] if status == 0 and out.split() else ''
        time.sleep(attempt)
    return None


def main():
    state = state_of(sys.argv[1])
    if state is None or state in GOING:
        print('running')
    else:
        print('success' if state in GOOD else 'failed')


if __name__ == '__main__':
    main()

#!/bin/sh
# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
# usage: slurm_status.sh JOB
# Prints what Snakemake wants to know of a job of Slurm: running, success or failed. Lost nodes count as failed: the job
# is sent again. While the controller does not answer, nothing is known of the job: it counts as running.
said=$(scontrol --oneliner show job "$1" 2>&1)
state=$(printf '%s\n' "$said" | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p')
if [ -z "$state" ] && printf '%s\n' "$said" | grep -q 'Invalid job id'; then
  state=$(sacct --noheader --allocations --format=State%20 --jobs="$1" 2>/dev/null | sed -n '1s/^ *\([A-Z_]*\).*/\1/p')
  state=${state:-UNKNOWN}
fi
case $state in
  COMPLETED) echo success ;;
  '' | PENDING | RUNNING | CONFIGURING | COMPLETING | SUSPENDED | STAGE_OUT | SIGNALING | REQUEUED | RESIZING) echo running ;;
  *) echo failed ;;
esac

#!/bin/bash
# An array of jobs draws a run or a sweep, and one more job makes the file once all are done. In a folder that all nodes see:
#   bash submit.sh 8 demo.h5 run demo.toml
#   bash submit.sh 8 gamma.h5 sweep demo.toml --over grading.gamma=0.2:2:10
set -euo pipefail
shares=$1 file=$2
shift 2
array=$(sbatch --parsable --array="1-$shares" "$(dirname "$0")/share.sbatch" "$@" -o "$file")
sbatch --dependency="afterok:$array" --job-name=mcgw-merge --wrap "mcgw merge '$file' && mcgw compare '$file'"

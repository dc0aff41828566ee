#!/bin/bash
# reuse_object.sh FOLDER COMPILER ARGUMENT...: a compiler launcher that copies the object file from
# another build of the same sources, FOLDER, where that has it, and compiles otherwise. Installing the
# core is tested without compiling it twice.
set -euo pipefail
folder=$1
shift
arguments=("$@")
for ((i = 0; i + 1 < ${#arguments[@]}; ++i)); do
  # The main file of the offline tool is another one with ROS.
  if [[ "${arguments[i]}" == -o && -f "$folder/${arguments[i + 1]}" &&
        "${arguments[i + 1]}" != *_main.cpp.o ]]; then
    exec cp "$folder/${arguments[i + 1]}" "${arguments[i + 1]}"
  fi
done
exec "$@"

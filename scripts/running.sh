# Functions for scripts that run programs for long; to be sourced.

# show_build_progress: shows the output of a build: on a terminal as one line that is replaced, in a
# log as the package's finished targets alone.
show_build_progress() {
  local line shown=false
  while IFS= read -r line; do
    [[ "$line" =~ ^\[\ *[0-9]+%\] ]] || continue
    if [[ -t 1 ]]; then
      printf '\r\033[K%s' "${line:0:100}"
      shown=true
    elif [[ "$line" == *"Built target"* && "$line" != *_generate_messages_* ]]; then
      printf '%s\n' "$line"
    fi
  done
  if $shown; then printf '\r\033[K'; fi
}

running=
before=
temporary=()

# run COMMAND...: runs a command as bash runs any, except that it ends, with all that it has started,
# when this script is ended.
run() {
  local status=0
  before=${!:-}
  running=starting
  set -m  # a process group of its own
  "$@" </dev/null &
  running=$!
  set +m
  wait "$running" || status=$?
  running=
  return "$status"
}

# end_running: ends what runs and removes what `temporary` names. For a trap on EXIT.
end_running() {
  if [[ "$running" == starting ]]; then  # interrupted before its number was taken note of
    running=${!:-}
    if [[ "$running" == "$before" ]]; then running=; fi
  fi
  if [[ -n "$running" ]]; then
    local patience
    kill -TERM -- "-$running" 2>/dev/null || true
    wait "$running" 2>/dev/null || true
    # What the command has left behind gets a second to end, and is ended then.
    for patience in 1 2 3 4 5 6 7 8 9 10; do
      kill -TERM -- "-$running" 2>/dev/null || break
      sleep 0.1
    done
    kill -KILL -- "-$running" 2>/dev/null || true
    running=
  fi
  if [[ ${#temporary[@]} -gt 0 ]]; then rm -rf -- "${temporary[@]}"; fi
}

# end_well NAME WORDS: ends everything with the script, and tells what is left when it is interrupted.
end_well() {
  local told="$1: interrupted; $2"
  trap end_running EXIT
  trap "echo >&2; echo '$told' >&2; exit 130" INT
  trap "echo '$told' >&2; exit 143" TERM HUP
}

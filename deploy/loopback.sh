# Sourced: a farm on loopback for a script, of the programs on PATH. It ends with the script, and $scratch goes, in which $data is
# the coordinator's folder.
scratch=$(mktemp -d)
data=$scratch/farm
pids=()
stop() {
  kill "${pids[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$scratch"
}
trap stop EXIT

# serve_here LOG [OPTION...]: the coordinator, ready; $data/join and $data/farm are its join strings.
serve_here() {
  local log=$1
  bandsaw serve --data "$data" --listen 127.0.0.1:0 "${@:2}" >"$log" 2>&1 &
  pids+=($!)
  until [ -s "$data/farm" ]; do  # the last that it writes
    kill -0 "${pids[0]}" 2>/dev/null || { cat "$log" >&2; exit 1; }
    sleep 0.05
  done
}

# work_here NAME LOG [OPTION...]: a worker of it.
work_here() {
  bandsaw-worker --join "$data/join" --name "$1" --cache "$scratch/cache-$1" "${@:3}" >"$2" 2>&1 &
  pids+=($!)
}

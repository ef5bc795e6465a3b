# To be sourced: functions that start a farm on loopback for a script, with the programs on PATH. The farm ends with the script. Then
# the folder $scratch is removed. It contains $data, the coordinator's data folder.
scratch=$(mktemp -d)
data=$scratch/farm
pids=()
stop() {
  kill "${pids[@]}" 2>/dev/null || true
  # A worker that holds bands would wait for the coordinator, which ends too. A second signal ends the worker at once.
  while kill "${pids[@]:1}" 2>/dev/null; do sleep 0.1; done
  wait 2>/dev/null || true
  rm -rf "$scratch"
}
trap stop EXIT

# serve_here LOG [OPTION...]: starts the coordinator and waits until it is ready; $data/join and $data/farm are the files with its join strings.
serve_here() {
  local log=$1
  bandsaw serve --data "$data" --listen 127.0.0.1:0 "${@:2}" >"$log" 2>&1 &
  pids+=($!)
  until [ -s "$data/farm" ]; do  # the file that the coordinator writes last
    kill -0 "${pids[0]}" 2>/dev/null || { cat "$log" >&2; exit 1; }
    sleep 0.05
  done
}

# join_here NAME LOG COMMAND...: starts a worker by a command and waits until it has joined.
join_here() {
  local name=$1 log=$2
  : >"$log"
  BANDSAW_JOIN=$(cat "$data/join") "${@:3}" --name "$name" --cache "$scratch/cache-$name" >"$log" 2>&1 &
  pids+=($!)
  until grep -q joined "$log"; do
    kill -0 "${pids[-1]}" 2>/dev/null || { cat "$log" >&2; exit 1; }
    sleep 0.05
  done
}

# work_here NAME LOG [OPTION...]: starts bandsaw-worker from PATH and waits until it has joined.
work_here() { join_here "$1" "$2" bandsaw-worker "${@:3}"; }

#!/usr/bin/env bash
# Tests that a farm of deploy/loopback.sh ends although its worker holds bands. Two scripts stand in for bandsaw and bandsaw-worker. The script
# of the worker ends only at the second signal, as bandsaw-worker does if it holds bands that no coordinator takes.
# Usage: loopback.sh SOURCE-FOLDER
set -euo pipefail
source=$(cd "$1" && pwd)
programs=$(mktemp -d)
trap 'rm -rf "$programs"' EXIT
cat > "$programs/bandsaw" << 'SCRIPT'
#!/usr/bin/env bash
mkdir "$3" && echo string | tee "$3/join" > "$3/farm"  # serve --data FOLDER
while true; do sleep 0.05; done
SCRIPT
cat > "$programs/bandsaw-worker" << 'SCRIPT'
#!/usr/bin/env bash
trap 'trap - TERM' TERM
echo joined
while true; do sleep 0.05; done
SCRIPT
chmod +x "$programs"/*

PATH=$programs:$PATH timeout 20 bash -euc '. "$1/deploy/loopback.sh"
  serve_here "$scratch/log"
  work_here desk "$scratch/desk.log"' bash "$source" || { echo "loopback.sh: the farm did not end" >&2; exit 1; }
echo "the farm ended"

#!/usr/bin/env bash
# Checks the units and the packages' script: a worker stops before the coordinator of its machine; a new or upgraded package restarts the
# right services; systemd accepts the units and rates their confinement as safe. Exit status 77: systemd-analyze is not installed, so
# systemd's checks of the units were skipped.
# Usage: deploy/systemd/test.sh FOLDER-OF-THE-PROGRAMS
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "$1" && pwd)
grep -q '^After=.*\bbandsaw\.service\b' "$here/bandsaw-worker.service" || {
  echo "bandsaw-worker.service must stop before bandsaw.service, because the coordinator takes the worker's last bands" >&2
  exit 1
}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
# This systemctl records its calls, and succeeds only for daemon-reload: a restart fails, as that of a masked unit does.
mkdir "$dir/bin"
printf '#!/bin/sh\necho "$*" >>"%s"\n[ "$1" = daemon-reload ]\n' "$dir/calls" >"$dir/bin/systemctl"
chmod +x "$dir/bin/systemctl"
# restarts PACKAGE OLD-VERSION SERVICE...: checks that the postinst script of the package restarts exactly these services, in this order,
# and succeeds although each restart fails. An empty old version stands for a new installation.
restarts() {
  : >"$dir/calls"
  sed "s#/run/systemd/system#$dir#" "$here/../packages/postinst" |
    DPKG_MAINTSCRIPT_PACKAGE=$1 PATH=$dir/bin:$PATH sh -s configure "$2" 2>/dev/null || {
    echo "postinst of $1: it fails if a service cannot be restarted" >&2
    exit 1
  }
  [ "$(sed -n 's/^--no-block try-restart //p' "$dir/calls" | xargs)" = "${*:3}" ] || {
    echo "postinst of $1, old version '$2': it does not restart '${*:3}':" >&2
    cat "$dir/calls" >&2
    exit 1
  }
}
restarts bandsaw ""
restarts bandsaw 0.1 bandsaw.service
restarts bandsaw-worker "" bandsaw.service
restarts bandsaw-worker 0.1 bandsaw.service bandsaw-worker.service
restarts bandsaw-worker-arm64 "" bandsaw.service
restarts bandsaw-worker-arm64 0.1 bandsaw.service
if ! command -v systemd-analyze >/dev/null; then
  echo "skipped: systemd-analyze is not here"
  exit 77
fi
for unit in "$here"/*.service "$here"/*.timer; do
  sed "s#=/usr/bin/bandsaw#=$programs/bandsaw#" "$unit" >"$dir/${unit##*/}"
done
said=$(systemd-analyze verify --man=no "$dir"/*.service "$dir"/*.timer 2>&1 | grep -e "$dir" -e bandsaw || true)
if [ -n "$said" ]; then
  echo "$said" >&2
  exit 1
fi
for unit in bandsaw bandsaw-worker; do
  # systemd rates the exposure of a service from 0 to 10; 10 is a service that may do everything. --threshold is in tenths: a rating
  # above 2.0 fails.
  systemd-analyze security --offline=true --threshold=20 --no-pager "$dir/$unit.service" >"$dir/found" || {
    cat "$dir/found" >&2
    exit 1
  }
  tail -n 1 "$dir/found"
done

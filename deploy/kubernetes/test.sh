#!/usr/bin/env bash
# Checks the files of this folder without a cluster: that kustomize can build them, that values that must agree are equal, and that the
# programs accept the options in the files.
# Exit status 77: kubectl is not installed.
# Usage: deploy/kubernetes/test.sh FOLDER-OF-THE-PROGRAMS
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "$1" && pwd)
if ! command -v kubectl >/dev/null; then
  echo "skipped: kubectl is not here"
  exit 77
fi
built=$(kubectl kustomize "$here")

has() { grep -q -e "$1" <<<"$built" || { echo "missing: $1" >&2; exit 1; }; }
for kind in Namespace Service StatefulSet Deployment NetworkPolicy; do
  has "^kind: $kind\$"
done
# The host name in the join string consists of the pod's name and the name of the service of its StatefulSet.
has '^  name: coordinator$'
has '^  serviceName: bandsaw$'
has '^        - 0.0.0.0:7878$'
grep -q 'coordinator-0.bandsaw:7878' "$here/README.md"
# The service has no address of its own. The pods of coordinator and workers do not run as root, and cannot write to their root file system.
[ "$(grep -c 'clusterIP: None' <<<"$built")" -eq 1 ]
[ "$(grep -c 'runAsNonRoot: true' <<<"$built")" -eq 2 ]
[ "$(grep -c 'readOnlyRootFilesystem: true' <<<"$built")" -eq 2 ]

help=$("$programs/bandsaw" serve --help)
for option in --data --listen --web; do
  has "^        - $option\$"
  grep -q -e "$option " <<<"$help" || { echo "bandsaw serve has no $option" >&2; exit 1; }
done
help=$("$programs/bandsaw-worker" --help)
for option in --join --cache --name --threads; do
  has "^        - $option\$"
  grep -q -e "$option " <<<"$help" || { echo "bandsaw-worker has no $option" >&2; exit 1; }
done
echo "the files agree with each other and with the options of the programs"

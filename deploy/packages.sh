#!/usr/bin/env bash
# Builds the Debian packages bandsaw and bandsaw-worker. With --try: installs them into a bare Debian 12, runs a farm in
# it, removes the packages and lists the files that are left. --try needs debootstrap and root.
# Usage: deploy/packages.sh [--try] [--worker FILE]... [FOLDER]   (default: out/packages)
# --worker FILE: the program bandsaw-worker of a build for another architecture. It gets a package of its own, bandsaw-worker-arm64 or
# bandsaw-worker-amd64. With this package, a coordinator on the architecture of this build hands out FILE to workers of the other
# architecture.
# BANDSAW_BUILD=DIR: the build to use. If it is set, nothing is installed or built.
set -euo pipefail
cd "$(dirname "$0")/.."
usage() { echo "usage: deploy/packages.sh [--try] [--worker FILE]... [FOLDER]" >&2; exit 2; }
try=
workers=()
while [[ "${1:-}" = -* ]]; do
  case $1 in
    --try) try=yes ;;
    --worker) [ $# -gt 1 ] || usage; workers+=("$2"); shift ;;
    *) usage ;;
  esac
  shift
done
[ $# -le 1 ] || usage

# machine FILE: the architecture of a 64-bit program, from its ELF header.
machine() {
  case $(od -An -v -tx1 -N20 "$1" | tr -d ' \n') in
    7f454c460201*3e00) echo x86_64 ;;
    7f454c460201*b700) echo aarch64 ;;
    *) echo "packages.sh: $1 is no program for x86_64 or aarch64" >&2; return 1 ;;
  esac
}
for worker in "${workers[@]}"; do
  machine "$worker" >/dev/null
done
mkdir -p "${1:-out/packages}"
folder=$(cd "${1:-out/packages}" && pwd)

. deploy/build.sh packages
components="bandsaw;bandsaw-worker"
packages=(bandsaw bandsaw-worker)
own=$(machine "$build/bin/bandsaw-worker")
machines=("$own")
for worker in "${workers[@]}"; do
  machine=$(machine "$worker")
  [ "$machine" != "$own" ] || { echo "packages.sh: $worker is for $own, the architecture of this build; --worker needs a program for another architecture" >&2; exit 1; }
  place=$build/lib/bandsaw/bandsaw-worker-$machine
  [ "$worker" -ef "$place" ] || install -D "$worker" "$place"
  [ "$machine" = aarch64 ] && package=bandsaw-worker-arm64 || package=bandsaw-worker-amd64
  components="$components;$package"
  packages+=("$package")
  machines+=("$machine")
done
(cd "$build" && cpack -G DEB -D CPACK_COMPONENTS_ALL="$components" -B "$folder" >"$folder/cpack.log") || {
  cat "$folder/cpack.log" >&2
  exit 1
}
rm -rf "$folder/_CPack_Packages"
ls -l "$folder"/*.deb
[ -n "$try" ] || exit 0

if ! command -v debootstrap >/dev/null || [ "$(id -u)" -ne 0 ]; then
  echo "packages.sh: --try needs debootstrap and root" >&2
  exit 1
fi
root=$(mktemp -d)
chmod 755 "$root"  # apt downloads as another user than root
stop() {
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf "$root"
}
trap stop EXIT
echo "a bare Debian 12 …"
debootstrap --variant=minbase bookworm "$root" "${BANDSAW_MIRROR:-http://deb.debian.org/debian}" >"$folder/debootstrap.log"
mount -t proc proc "$root/proc"
files() { chroot "$root" find / -xdev \( -path /proc -o -path /var/cache/apt -o -path /var/lib/apt \) -prune -o -print | sort; }
chroot "$root" apt-get update -qq
files >"$folder/files-before"

cp "$folder"/*.deb "$root/tmp/"
echo "install:"
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /tmp/*.deb' >"$folder/install.log" 2>&1
rm "$root"/tmp/*.deb
[ "$(stat -c %a "$root/etc/bandsaw/join")" = 600 ]
handed_out=$(chroot "$root" bandsaw doctor | grep ' workers ' || true)
for machine in "${machines[@]}"; do
  [[ $handed_out = *" $machine ("* ]] || { echo "packages.sh: no worker for $machine is handed out: $handed_out" >&2; exit 1; }
done
echo "run: a coordinator, two workers, a scene of the gallery"
chroot "$root" bash -euc '
  cd /root
  bandsaw serve --data farm --listen 127.0.0.1:0 --web 127.0.0.1:0 >serve.log 2>&1 & serve=$!
  until [ -s farm/farm ]; do kill -0 $serve; sleep 0.1; done
  bandsaw-worker --join farm/join --name anna --threads 1 --cache cache >anna.log 2>&1 & anna=$!
  bandsaw-worker --join farm/join --name ben --threads 1 --cache cache >ben.log 2>&1 & ben=$!
  bandsaw submit /usr/share/bandsaw/gallery/pergola.textproto --farm farm/farm --samples 16 --width 96 -o farm.pfm
  bandsaw render /usr/share/bandsaw/gallery/pergola.textproto --samples 16 --width 96 -o here.pfm
  cmp farm.pfm here.pfm
  kill $anna $ben; wait $anna $ben
  kill $serve; wait $serve
  cd / && rm -rf /root/farm /root/cache /root/*.log /root/*.pfm /root/*.json'
echo "remove:"
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get purge -y -qq --auto-remove "$@"' sh "${packages[@]}" >"$folder/remove.log" 2>&1
files >"$folder/files-after"
left=$(comm -13 "$folder/files-before" "$folder/files-after" | grep -v -e '^/var/log/' -e '^/var/lib/dpkg/' -e '^/var/cache/' -e '^/etc/ld.so.cache$' || true)
echo "left: ${left:-nothing}"
[ -z "$left" ]

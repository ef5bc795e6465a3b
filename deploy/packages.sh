#!/usr/bin/env bash
# Builds the Debian packages bandsaw and bandsaw-worker. With --try: installs them into a bare Debian 12 (debootstrap; root),
# runs a farm there, removes them and lists what is left.
# Usage: deploy/packages.sh [--try] [FOLDER]   (default: out/packages)
# BANDSAW_BUILD=DIR: use that build; nothing is installed or built.
set -euo pipefail
cd "$(dirname "$0")/.."
try=
[ "${1:-}" = --try ] && { try=yes; shift; }
mkdir -p "${1:-out/packages}"
folder=$(cd "${1:-out/packages}" && pwd)

. deploy/build.sh packages
(cd "$build" && cpack -G DEB -B "$folder" >"$folder/cpack.log") || {
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
chmod 755 "$root"  # apt fetches as a user of its own
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
chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get purge -y -qq --auto-remove bandsaw bandsaw-worker' >"$folder/remove.log" 2>&1
files >"$folder/files-after"
left=$(comm -13 "$folder/files-before" "$folder/files-after" | grep -v -e '^/var/log/' -e '^/var/lib/dpkg/' -e '^/var/cache/' -e '^/etc/ld.so.cache$' || true)
echo "left: ${left:-nothing}"
[ -z "$left" ]

# Sourced: a bare Debian in a folder, for scripts that try what a new machine does. Needs root and debootstrap.
# BANDSAW_MIRROR: where its packages come from (default: http://deb.debian.org/debian).

# bare_possible: whether this machine can make one; says why not.
bare_possible() {
  if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
    echo "a bare Debian needs root and debootstrap" >&2
    return 1
  fi
}

# bare_make ROOT RELEASE: the minimal system of a release (bookworm is Debian 12, trixie is Debian 13) in the folder ROOT,
# which stays as it is if it holds one already.
bare_make() {
  local root=$1 release=$2
  if [ ! -e "$root/etc/debian_version" ]; then
    mkdir -p "$root"
    chmod 755 "$root"  # apt fetches as a user of its own
    debootstrap --variant=minbase "$release" "$root" "${BANDSAW_MIRROR:-http://deb.debian.org/debian}"
  fi
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
}

# bare_close ROOT: takes back what bare_make mounted. MUST come before the folder is removed.
bare_close() {
  ! mountpoint -q "$1/proc" || umount "$1/proc"
}

# bare_run ROOT COMMAND: a shell command in it, in root's home folder, with the environment of a new login.
bare_run() {
  chroot "$1" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb LANG=C.UTF-8 bash -euo pipefail -c "cd; $2"
}

# bare_clone ROOT: a fresh clone of this checkout's last commit in its /root/bandsaw, in the place of an older one.
# The old one's build folder stays.
bare_clone() {
  local clone=$1/root/bandsaw kept=$1/root/build
  [ ! -e "$clone/build" ] || { rm -rf "$kept"; mv "$clone/build" "$kept"; }
  rm -rf "$clone"
  git clone --quiet --no-hardlinks . "$clone"
  [ ! -e "$kept" ] || mv "$kept" "$clone/build"
}

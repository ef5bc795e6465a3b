# To be sourced: functions that make and use a bare (minimal) Debian system in a folder, for scripts that test an installation as on a
# new machine. The functions need root and debootstrap.
# BANDSAW_MIRROR: address of the package mirror (default: http://deb.debian.org/debian).

# bare_possible: succeeds if this machine can make a bare system. Otherwise prints the reason and fails.
bare_possible() {
  if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
    echo "a bare Debian needs root and debootstrap" >&2
    return 1
  fi
}

# bare_make ROOT RELEASE: makes the minimal system of a release (bookworm is Debian 12, trixie is
# Debian 13) in the folder ROOT, unless ROOT contains a system already. In both cases, copies this
# machine's resolv.conf to the system, and mounts /proc and /dev/pts in the system.
bare_make() {
  local root=$1 release=$2
  if [ ! -e "$root/etc/debian_version" ]; then
    mkdir -p "$root"
    chmod 755 "$root"  # apt downloads as another user than root
    debootstrap --variant=minbase "$release" "$root" "${BANDSAW_MIRROR:-http://deb.debian.org/debian}"
  fi
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  # The system gets terminals of its own, for tests that need one.
  mountpoint -q "$root/dev/pts" || mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts "$root/dev/pts"
}

# bare_close ROOT: unmounts everything that bare_make mounted. MUST be called before the folder is removed.
bare_close() {
  ! mountpoint -q "$1/dev/pts" || umount "$1/dev/pts"
  ! mountpoint -q "$1/proc" || umount "$1/proc"
}

# bare_run ROOT COMMAND: runs a shell command in the system, in root's home folder, with the environment of a new login.
bare_run() {
  chroot "$1" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb LANG=C.UTF-8 bash -euo pipefail -c "cd; $2"
}

# bare_clone ROOT: makes a fresh clone of this checkout's last commit in the system's /root/bandsaw. The new clone replaces an older
# one, but keeps the older clone's build folder.
bare_clone() {
  local clone=$1/root/bandsaw kept=$1/root/build
  [ ! -e "$clone/build" ] || { rm -rf "$kept"; mv "$clone/build" "$kept"; }
  rm -rf "$clone"
  git clone --quiet --no-hardlinks . "$clone"
  [ ! -e "$kept" ] || mv "$kept" "$clone/build"
}

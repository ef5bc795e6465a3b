#!/usr/bin/env bash
# Runs deploy/tutorial.md, block by block, on three machines made of network namespaces. Exit status 77: these machines cannot be made
# here, for example because the script does not run as root. A block begins with the line ```sh on=HOST, where HOST is the machine that runs it. A
# word may follow HOST. `stays`: after the block has printed "join", it continues in the background. `stops`: the block is not run; the background
# blocks of HOST are ended instead.
# Usage: tutorial.sh BUILD-FOLDER
set -euo pipefail
build=$(cd "$1" && pwd)
page=$(cd "$(dirname "$0")/../.." && pwd)/deploy/tutorial.md
work=$(mktemp -d)
net=bandsaw-$$
hosts=(studio desk attic)

finish() {
  for pids in "$work"/*/pids; do [ -f "$pids" ] && xargs kill <"$pids" 2>/dev/null || true; done
  wait
  for host in switch "${hosts[@]}"; do ip netns delete "$net-$host" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT

# Makes a network namespace for each host, and one for the switch that connects them.
make_hosts() {
  ip netns add "$net-switch"
  ip -netns "$net-switch" link add bridge type bridge
  ip -netns "$net-switch" link set bridge up
  local number=0
  for host in "${hosts[@]}"; do
    number=$((number + 1))
    mkdir "$work/$host"
    ip netns add "$net-$host"
    ip -netns "$net-switch" link add "$host" type veth peer name cable netns "$net-$host"
    ip -netns "$net-switch" link set "$host" master bridge up
    ip -netns "$net-$host" link set lo up
    ip -netns "$net-$host" address add "10.78.0.$number/24" dev cable
    ip -netns "$net-$host" link set cable up
  done
}

# Prints the block with JOIN and FARM replaced by the text that a user would paste.
pasted() {
  local text=$1 farm=$work/studio/farm
  [ -s "$farm/join" ] && text=${text//--join JOIN/--join $(cat "$farm/join")}
  [ -s "$farm/farm" ] && text=${text//--farm FARM/--farm $(cat "$farm/farm")}
  printf '%s' "$text"
}

# Runs a block on a host. `how` is the word that follows HOST: `stays`, `stops` or nothing.
run_block() {  # host how block
  local host=$1 how=$2 text
  text=$(pasted "$3")
  cd "$work/$host"
  local machine=(ip netns exec "$net-$host" env -i "HOME=$PWD" "PATH=$build/bin:/usr/bin:/bin:/usr/sbin" bash -euo pipefail -c)
  case $how in
    stays)
      "${machine[@]}" "exec $text" >log 2>&1 &
      echo $! >>pids
      until grep -q join log; do
        kill -0 $! || { cat log; return 1; }
        sleep 0.1
      done ;;
    stops) xargs kill <pids ; rm pids ;;
    *) "${machine[@]}" "$text" ;;
  esac
}

make_hosts 2>/dev/null || { echo "tutorial.sh needs root, and a kernel with network namespaces"; exit 77; }
host= how= text=
while IFS= read -r line; do
  case $line in
    '```sh on='*) read -r _ host how <<<"${line/on=/}"; text= ;;
    '```')
      if [ -n "$host" ]; then
        echo "--- $host${how:+ ($how)}"
        run_block "$host" "$how" "$text" </dev/null
      fi
      host= ;;
    *) [ -n "$host" ] && text+=$line$'\n' ;;
  esac
done <"$page"
echo "all blocks of the tutorial ran"

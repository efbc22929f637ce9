# The bus of a set of services: multicast route, port, and the register of running sets. Sourced after lib.sh.
# shellcheck shell=bash

# need_multicast ARG…: makes sure that LCM's multicast group can be reached. Without a route and without the right to make one, the calling script starts
# again with ARG… in a network namespace of its own, where it may.
need_multicast() {
  ip route get "$nbs_group" >/dev/null 2>&1 && return
  if (($(id -u) == 0)) && [[ -z ${NBS_NAMESPACE_PID:-} ]]; then
    ip link set lo up 2>/dev/null && ip route add "$nbs_group/32" dev lo 2>/dev/null && return
    # Another run may have made it at the same moment.
    ip route get "$nbs_group" >/dev/null 2>&1 && return
  elif [[ -z ${NBS_NAMESPACE_PID:-} ]] && unshare -Urn true 2>/dev/null; then
    export NBS_NAMESPACE_PID=$$ NBS_STATE_DIR=$nbs_state NBS_READY=1
    # shellcheck disable=SC2016
    exec unshare -Urn -- bash -c 'ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"' bash "$0" "$@"
  fi
  fail "no multicast route for LCM and no right to make one: run as root \`ip route add $nbs_group/32 dev lo\`, then try again"
}

# is_taken PORT: true if somebody, of whatever user, listens to the UDP port.
is_taken() { grep -Eq "^ *[0-9]+: [0-9A-F]{8}:$(printf %04X "$1") " /proc/net/udp 2>/dev/null; }

# take_port: a port that no other set uses; sets nbs_url. The lock is inherited by the services, so the port is free again only when the last of them is gone.
# Each user has a range: locks are seen by one user only. Where two share one, they see each other's sockets.
take_port() {
  make_state_folder
  local port first=$((20000 + $(id -u) % 120 * 100))
  for ((port = first; port < first + 100; ++port)); do
    ! is_taken "$port" || continue
    exec {nbs_port_lock}>>"$nbs_state/port-$port"
    if flock -n "$nbs_port_lock"; then
      # ttl=0: no datagram leaves this machine.
      nbs_url="udpm://$nbs_group:$port?ttl=0&recv_buf_size=4194304"
      return
    fi
    exec {nbs_port_lock}>&-
  done
  fail "a hundred sets run already: stop some with scripts/stop"
}

# register_set RUN SERVICE…: tells stop, spy and launch about this set until this process ends.
register_set() {
  local run=$1
  shift
  nbs_set_file=$nbs_state/sets/$$
  exec {nbs_set_lock}>"$nbs_set_file"
  flock "$nbs_set_lock"
  printf '%s\n' "$run" "$nbs_url" "${NBS_NAMESPACE_PID:-}" "$*" >"$nbs_set_file"
}

forget_set() { [[ -z ${nbs_set_file:-} ]] || rm -f "$nbs_set_file"; }

# running_sets: the process numbers of the sets that run, newest first. Forgets those whose process has ended.
running_sets() {
  local file
  [[ -d $nbs_state/sets ]] || return 0
  while read -r file; do
    if flock -n "$nbs_state/sets/$file" true 2>/dev/null; then
      rm -f "$nbs_state/sets/$file"
    else
      printf '%s\n' "$file"
    fi
  done < <(ls -t "$nbs_state/sets")
}

# read_set PID: sets set_run, set_url, set_namespace, set_services.
read_set() {
  local lines
  mapfile -t lines <"$nbs_state/sets/$1"
  set_run=${lines[0]:-} set_url=${lines[1]:-} set_namespace=${lines[2]:-} set_services=${lines[3]:-}
}

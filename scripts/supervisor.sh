# Starts services, restarts what dies, stops everything. Sourced after lib.sh and bus.sh; the caller sets nbs_run and nbs_url.
# shellcheck shell=bash

declare -A nbs_service_of=()   # process number -> service
declare -A nbs_deaths=()       # service -> seconds of its deaths
nbs_service_options=()         # for every service of the set
nbs_give_up_deaths=5           # this many deaths …
nbs_give_up_seconds=30         # … within this time end the run
nbs_stop_seconds=10            # after a TERM; then KILL

# note TEXT: a line in RUN/logs/supervisor.log.
note() { printf '%(%F %T)T %s\n' -1 "$*" 2>/dev/null >>"$nbs_run/logs/supervisor.log" || true; }

# start_service NAME: nbs-NAME in a session of its own (a Ctrl-C reaches only the supervisor), killed by the kernel should the supervisor itself be killed.
# The reporter's lines are the terminal's, and it ends with the run; the others serve repair until they are stopped, and write to RUN/logs/NAME.log.
# NBS_SERVICE_OPTIONS: more options for every service, for tests.
start_service() {
  local name=$1 log=$nbs_run/logs/$1.log
  local extra=()
  read -ra extra <<<"${NBS_SERVICE_OPTIONS:-}"
  local command=(setsid setpriv --pdeathsig KILL -- "$nbs_bin/nbs-$name" --run "$nbs_run" --lcm-url "$nbs_url" "${nbs_service_options[@]}" "${extra[@]}")
  if [[ $name == reporter ]]; then
    "${command[@]}" --exit-when-finished 2>>"$log" </dev/null &
  else
    "${command[@]}" >>"$log" 2>&1 </dev/null &
  fi
  nbs_service_of[$!]=$name
  note "started $name, process $!"
}

# need_programs NAME…: refuses to begin when one is not built.
need_programs() {
  local name
  for name in "$@"; do
    [[ -x $nbs_bin/nbs-$name ]] || fail "$nbs_bin/nbs-$name is missing: run scripts/build"
  done
}

# start_services NAME…
start_services() {
  local name
  for name in "$@"; do start_service "$name"; done
}

# stop_services: TERM to all, KILL to those that do not listen; returns when none is left.
stop_services() {
  local pid deadline=$((SECONDS + nbs_stop_seconds))
  for pid in "${!nbs_service_of[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  while ((${#nbs_service_of[@]})); do
    for pid in "${!nbs_service_of[@]}"; do
      if ! kill -0 "$pid" 2>/dev/null; then
        unset "nbs_service_of[$pid]"
      elif ((SECONDS >= deadline)); then
        say "supervisor: ${nbs_service_of[$pid]} does not stop: killed"
        note "killed ${nbs_service_of[$pid]}, which did not stop"
        kill -KILL "$pid" 2>/dev/null || true
        wait "$pid" 2>/dev/null || true
        unset "nbs_service_of[$pid]"
      fi
    done
    sleep 0.02
  done
  note "all services stopped"
}

# last_words NAME: the last line of its log; says so when the disk is full, because the log then could not be written either.
last_words() {
  local free words
  words=$(tail -n 1 "$nbs_run/logs/$1.log" 2>/dev/null) || words=
  free=$(df --output=avail -k "$nbs_run" 2>/dev/null | tail -n 1) || free=
  if [[ -n $free && $words != *'no space left'* ]] && ((free < 1024)); then words+=" (no space left on the disk of $nbs_run)"; fi
  printf '%s' "$words"
}

# died_too_often NAME: notes a death; true when there were too many in quick succession.
died_too_often() {
  local name=$1 now=$SECONDS second recent=()
  for second in ${nbs_deaths[$name]:-} "$now"; do
    ((now - second < nbs_give_up_seconds)) && recent+=("$second")
  done
  nbs_deaths[$name]=${recent[*]}
  ((${#recent[@]} >= nbs_give_up_deaths))
}

# handle_end PID CODE: what follows from the end of a process. Returns 0 to go on; otherwise the exit code of the run. A service that was told to stop by
# somebody else ends with the code of that signal.
handle_end() {
  local name=${nbs_service_of[$1]:-} code=$2
  [[ -n $name ]] || return 0
  unset "nbs_service_of[$1]"
  if ((code == 0)); then
    note "$name has finished"
    return 0
  fi
  if ((code < 128)); then
    say "supervisor: $name ended with exit code $code: $(last_words "$name")"
    note "$name ended with exit code $code"
    ((code == 1)) && return 1
    return 2
  fi
  local signal
  signal=$(kill -l $((code - 128)) 2>/dev/null) || signal=$((code - 128))
  if died_too_often "$name"; then
    say "supervisor: $name died $nbs_give_up_deaths times within $nbs_give_up_seconds s (signal $signal): giving up (see $nbs_run/logs/$name.log)"
    note "$name died of signal $signal, too often: giving up"
    return 2
  fi
  start_service "$name"
  say "supervisor: $name died of signal $signal; started again"
  note "$name died of signal $signal; started again"
}

# supervise NAME: keeps the services running until NAME has finished (or, if it is not among them, all have). Returns 0, or the exit code of a run that failed.
supervise() {
  local until_name=$1 pid code name result
  while ((${#nbs_service_of[@]})); do
    pid= code=0
    # Bash reports a child that died of a signal on its own stderr as well: once is enough.
    { wait -n -p pid "${!nbs_service_of[@]}" || code=$?; } 2>/dev/null
    [[ -n $pid ]] || continue
    name=${nbs_service_of[$pid]:-}
    result=0
    handle_end "$pid" "$code" || result=$?
    ((result == 0)) || return "$result"
    if ((code == 0)) && [[ $name == "$until_name" ]]; then return 0; fi
  done
}

# register_scans: where the cell asks for it, RUN/registered: the scans registered with each other and meshed anew. Out of a Ctrl-C's reach.
register_scans() {
  local code=0
  setsid -w setpriv --pdeathsig KILL -- "$nbs_bin/nbs-remesh" --run "$nbs_run" 2>>"$nbs_run/logs/remesh.log" </dev/null || code=$?
  if ((code == 0)); then return; fi
  say "the scans could not be registered with each other: $(last_words remesh)"
  return 2
}

# write_report: folds RUN/streams into the run's results, also after a run that was cut short. Out of a Ctrl-C's reach.
write_report() {
  local code=0
  setsid -w setpriv --pdeathsig KILL -- "$nbs_bin/nbs-reporter" --run "$nbs_run" --offline 2>>"$nbs_run/logs/reporter.log" </dev/null || code=$?
  if ((code == 0)); then return; fi
  say "the report could not be written: $(last_words reporter)"
  return 2
}

# report_value KEY: a text or number at the top of report.json.
report_value() {
  sed -n "s/^  \"$1\": \"\{0,1\}\(.*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" "$nbs_run/report.json" 2>/dev/null | sed 's/\\"/"/g'
}

# has_failed: true unless the report says that the run came to a good end.
has_failed() { [[ $(report_value failed) != false ]]; }

# finish_run CODE: stops the services, writes the results, says where they are, and ends the script. CODE 0 becomes 2 if the run itself failed; a run that
# never began (CODE 1) has no results.
finish_run() {
  local code=$1 words
  trap '' INT TERM HUP
  stop_services
  if ((code != 1)); then
    register_scans || code=$((code == 0 ? 2 : code))
    if write_report; then
      if ((code == 0)) && has_failed; then
        code=2
        words=$(report_value end_detail)
        say "the run failed: ${words:-$(report_value end_reason)}"
      fi
      printf '%s\n' "run folder: $nbs_run" || true
    elif ((code == 0)); then
      code=2
    fi
  fi
  forget_set
  trap - EXIT
  exit "$code"
}

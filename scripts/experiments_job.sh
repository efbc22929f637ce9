# One run, or one oracle, of scripts/experiments. Sourced after lib.sh.
# shellcheck shell=bash

# label_of OBJECT: what it is called in the folder and on the page.
label_of() {
  local name=${1##*/}
  printf '%s' "${name%.*}"
}

# method_folder METHOD: BH/IG:sum is kept in BH-IG+sum.
method_folder() {
  local folder=${1//\//-}
  printf '%s' "${folder/:/+}"
}

# read_method METHOD: sets method_options, as scripts/scan and nbs-prepare want them.
read_method() {
  method_options=(--method "${1%%:*}")
  if [[ $1 == *:* ]]; then method_options+=(--gain "${1#*:}"); fi
}

# report_says FILE KEY: a text or number at the top of a report.
report_says() { sed -n "s/^  \"$2\": \"\{0,1\}\(.*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" "$1" 2>/dev/null; }

# run_done FOLDER: true if the run came to a good end and its report is whole.
run_done() { [[ $(report_says "$1/report.json" failed) == false && $(tail -c 2 "$1/report.json") == '}' ]]; }

# oracle_done FOLDER PATHS
oracle_done() { [[ $(report_says "$1/oracle.json" paths) == "$2" ]]; }

# explain PLACE CODE: why a job failed, in one line.
explain() {
  local words
  words=$(grep -v '^run folder:\|^ *[0-9]\+  [a-z]\|^scan \|^oracle: ' "$1.log" 2>/dev/null | tail -n 1) || words=
  printf '%s (exit code %d, see %s.log)\n' "${words:-it said nothing}" "$2" "$1"
}

# name_job KIND OBJECT METHOD SEED
name_job() {
  if [[ $1 == oracle ]]; then
    printf '%s, oracle of %s paths' "$(label_of "$2")" "$4"
  else
    printf '%s, %s, seed %s' "$(label_of "$2")" "$3" "$4"
  fi
}

# sum_up KIND PLACE
sum_up() {
  if [[ $1 == oracle ]]; then
    printf 'sees %s of the surface' "$(report_says "$2/oracle.json" seen_by_any)"
  else
    printf '%s scans, coverage %s' "$(report_says "$2/report.json" n_scans)" "$(report_says "$2/report.json" coverage)"
  fi
}

# do_run, do_oracle: in do_job's variables. A run has no end by mesh completeness: with 1 it ends so only when no border edge is left at all.
do_run() {
  local method_options
  read_method "$method"
  "$nbs_root/scripts/scan" --object "$object" "${method_options[@]}" --seed "$seed" --cell "$cell" --max-scans "$max_scans" --completeness 1 --out "$place" || return $?
  run_done "$place" || { echo "the run has no whole report" && return 2; }
  "$nbs_bin/nbs-pictures" --run "$place" --after 5 15 30 || return $?
  if [[ $keep_streams != yes ]]; then rm -rf "$place/streams" "$place/registered" "$place/bus.lcm"; fi
}

do_oracle() {
  "$nbs_bin/nbs-prepare" --object "$object" --cell "$cell" --out "$place" || return $?
  "$nbs_bin/nbs-oracle" --run "$place" --paths "$seed"
}

# do_job KIND OBJECT METHOD SEED PLACE CELL MAX_SCANS KEEP_STREAMS: prints one line: done or failed, and what. Beside PLACE it leaves PLACE.log, and PLACE.failed
# with the reason. KIND is run, or oracle, whose SEED is its number of paths.
do_job() {
  local kind=$1 object=$2 method=$3 seed=$4 place=$5 cell=$6 max_scans=$7 keep_streams=$8
  local what start=$SECONDS code=0
  what=$(name_job "$kind" "$object" "$method" "$seed")
  # parallel sends its signal to all that a job started: what runs ends by itself, then this.
  trap 'exit 130' INT TERM HUP
  mkdir -p "$(dirname "$place")" 2>/dev/null || true
  rm -rf "$place" "$place.failed"
  ("do_$kind") >"$place.log" 2>&1 </dev/null || code=$?
  if ((code == 0)); then
    printf 'done %s: %s, %d s\n' "$what" "$(sum_up "$kind" "$place")" $((SECONDS - start))
    return
  fi
  explain "$place" "$code" >"$place.failed" 2>/dev/null || true
  printf 'failed %s: %s\n' "$what" "$(explain "$place" "$code")"
}

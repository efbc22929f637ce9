# The options that describe a run, shared by scan and launch. Sourced after lib.sh.
# shellcheck shell=bash

print_run_options() {
  cat <<'USAGE'
  --object NAME|FILE     statue (made by the project; default) or a mesh of your own: PLY, STL, OBJ, in metres
  --method METHOD        BH/IG (default), B/IG, B, S/IG, S
  --gain RULE            by what candidates are rated: surface, sum (eq. 2), near_surface, mean, per_second, unknown_count (default: the method's own)
  --cell NAME            a cell of sim/cells, or a file (default: free)
  --completeness C       wanted mesh completeness, 0 to 1 (default: 0.9875)
  --max-scans N          ends after that many scans (default: 30)
  --seed N               the same seed gives the same run, bit for bit (default: 1)
  --rate max|realtime    as fast as the machine can (default), or as the robot would move
  --out DIR              the run folder (default: runs/<object>-<method>-seed<seed>-<time>)
USAGE
}

nbs_prepare_options=()
run_object=statue
run_method=BH/IG
run_seed=1
run_out=

# take_run_option OPTION VALUE: true if it is one of them.
take_run_option() {
  [[ -n $2 ]] || fail "option $1 needs a value, not an empty one"
  case $1 in
    --object) run_object=$2 ;;
    --method) run_method=$2 ;;
    --seed)
      [[ $2 =~ ^(0|[1-9][0-9]{0,17})$ ]] || fail "--seed must be a whole number from 0, of at most 18 digits, not \`$2\`"
      run_seed=$2
      ;;
    --box) run_object= ;;
    --out) run_out=$2 && return ;;
    --gain | --cell | --completeness | --max-scans | --rate) ;;
    *) return 1 ;;
  esac
  nbs_prepare_options+=("$1" "$2")
}

# A fresh folder under runs/ for a run without --out.
default_out() {
  local object=${run_object##*/} base
  object=${object%.*}
  base=$nbs_runs/${object:-object}-${run_method//\//-}-seed$run_seed-$(date +%Y%m%d-%H%M%S)
  local out=$base number=1
  while ! { mkdir -p "$nbs_runs" && mkdir "$out"; } 2>/dev/null; do
    [[ -e $out ]] || fail "cannot make the run folder $out"
    out=$base-$((++number))
  done
  printf '%s\n' "$out"
}

# check_space FOLDER: a run needs room for its streams, its log and its results.
check_space() {
  local folder=$1 free needed_mb=300
  while [[ ! -e $folder ]]; do folder=$(dirname "$folder"); done
  free=$(df --output=avail -m "$folder" | tail -n 1)
  ((free >= needed_mb)) || fail "only $((free)) MB are free in $folder: a run needs about $needed_mb MB"
}

# software_version: the project's version, and the commit where git knows it.
software_version() {
  local version commit
  version=$(sed -n 's/^project(.* VERSION \([0-9.]*\).*/\1/p' "$nbs_root/CMakeLists.txt")
  commit=$(git -C "$nbs_root" describe --always --dirty 2>/dev/null) || commit=
  printf '%s%s\n' "$version" "${commit:+ ($commit)}"
}

run_own=     # the folder of the run, once it is known to be nobody else's
run_existed= # it was there before, empty

# discard_run CODE: ends the script; leaves of a run that cannot begin what was there before: nothing, or an empty folder.
discard_run() {
  trap '' INT TERM HUP
  if [[ -n $run_own && -n $run_existed ]]; then
    find "$run_own/" -mindepth 1 -delete
  elif [[ -n $run_own ]]; then
    rm -rf "$run_own"
  fi
  exit "$1"
}

# prepare_run: checks the options, makes the run folder with run.yaml, and has the planner check that the robot can begin; sets nbs_run. Until the caller sets
# another trap an interrupt discards the run.
prepare_run() {
  trap 'discard_run 130' INT TERM HUP
  check_space "$(canonical "${run_out:-$nbs_runs}")"
  if [[ -z $run_out ]]; then
    run_out=$(default_out)
    run_own=$run_out
  fi
  nbs_run=$(canonical "$run_out")
  if [[ -e $nbs_run && -z $run_own ]]; then
    run_existed=yes
  elif mkdir "$nbs_run" 2>/dev/null; then
    run_own=$nbs_run
  fi
  "$nbs_bin/nbs-prepare" "${nbs_prepare_options[@]}" --out "$nbs_run" --version "$(software_version)" || discard_run 1
  run_own=$nbs_run
  "$nbs_bin/nbs-planner" --run "$nbs_run" --check || discard_run 1
  mkdir -p "$nbs_run/logs"
}

#!/usr/bin/env bash
# Stands in for every executable of the project in the tests of the scripts: a service that runs until RUN/finish exists, and does what RUN/<service>.order
# says: "exit CODE SENTENCE". RUN/finish names the end of the run; RUN/failed says that it failed.
set -euo pipefail
name=$(basename "$0")
name=${name#nbs-}
run= out= url= offline= check= options="$*"
while (($#)); do
  case $1 in
    --run) run=$2 ;;
    --out) out=$2 ;;
    --lcm-url) url=$2 ;;
    --offline) offline=yes ;;
    --check) check=yes ;;
  esac
  shift
done

if [[ $name == prepare ]]; then
  [[ $options != *--method\ BAD* ]] || { echo 'unknown method `BAD`' >&2 && exit 1; }
  mkdir -p "$out"
  echo "name: fake" >"$out/run.yaml"
  [[ $options != *slow.ply* ]] || touch "$out/slow"
  exit 0
fi
if [[ $name == remesh ]]; then
  [[ ! -e $run/unregistrable ]] || { echo 'a history is damaged' >&2 && exit 2; }
  exit 0
fi
if [[ -n $offline ]]; then
  [[ ! -e $run/unwritable ]] || { echo 'no space left' >&2 && exit 2; }
  failed=false
  [[ -e $run/finish && ! -e $run/failed ]] || failed=true
  printf '{\n  "end_reason": "%s",\n  "end_detail": "Said \\"so\\", fully.",\n  "failed": %s,\n  "n_scans": 3\n}\n' \
    "$(cat "$run/finish" 2>/dev/null || echo interrupted)" "$failed" >"$run/report.json"
  exit 0
fi

if [[ -n $check ]]; then
  [[ ! -e $run/slow ]] || { : >"$run/checking" && exec sleep 60; }
  exit 0
fi
trap 'exit 143' TERM
echo "$$ $url" >>"$run/$name.starts"
[[ $name != reporter ]] || echo 'scan 0'
while [[ ! -e $run/finish ]]; do
  if [[ -e $run/$name.order ]]; then
    read -r code sentence <"$run/$name.order"
    echo "$sentence" >&2
    ((code < 128)) || kill -KILL $$
    exit "$code"
  fi
  sleep 0.02
done

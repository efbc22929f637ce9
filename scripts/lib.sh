# Functions that the scripts share; sourced, never run. Every script that sources it has set -euo pipefail.
# shellcheck shell=bash

nbs_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# A test may point to another build; NBS_READY=1 then says that packages and build are in place.
nbs_build=${NBS_BUILD_DIR:-$nbs_root/build/release}
nbs_bin=$nbs_build/bin
nbs_runs=${NBS_RUNS_DIR:-$nbs_root/runs}
# What runs at the moment: ports, their locks, one file per running set.
nbs_state=${NBS_STATE_DIR:-${TMPDIR:-/tmp}/next-best-scan-$(id -u)}
nbs_group=239.255.76.67

# say TEXT: a line for the user that is no result. Through a copy of stderr, because a trap may run while stderr is turned away; a terminal that is gone is no
# reason to stop half-way.
exec {nbs_stderr}>&2
say() { printf '%s\n' "$*" >&"$nbs_stderr" || true; }

# fail TEXT: bad input or configuration, in one sentence.
fail() {
  say "${0##*/}: $*"
  exit 1
}

# need_value OPTION COUNT: refuses an option without its value; COUNT is what is left of the command line.
need_value() { (($2 >= 2)) || fail "option $1 needs a value (see $(basename "$0") --help)"; }

# refuse_option WORD
refuse_option() { fail "unknown option or argument \`$1\` (see $(basename "$0") --help)"; }

# ready GROUP…: packages and all programs in place, quick and silent when they are. The tests are built by scripts/test only.
ready() {
  [[ -n ${NBS_READY:-} ]] && return
  "$nbs_root/scripts/setup" "$@" || exit $?
  "$nbs_root/scripts/build" --quiet nbs_programs || exit $?
}

# A folder for the state that only this user can write.
make_state_folder() {
  mkdir -p -m 700 "$nbs_state/sets" 2>/dev/null || fail "cannot make the folder $nbs_state"
  [[ -O $nbs_state ]] || fail "the folder $nbs_state belongs to somebody else: set NBS_STATE_DIR to one of your own"
}

# canonical PATH: absolute, without links, whether or not it exists.
canonical() { realpath -m -- "$1"; }

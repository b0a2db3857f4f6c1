#!/usr/bin/env bash
# Whether a program was linked and compiled as DYNAMIC_ICP_HARDENING asks: loaded anywhere, no stack that is executed,
# no table of functions that can be written, guarded stacks, checked calls of the C library. Status 1 if not.
# usage: scripts/check_hardening.sh PROGRAM
set -euo pipefail
[[ $# -eq 1 && -f $1 ]] || { echo "usage: scripts/check_hardening.sh PROGRAM" >&2; exit 2; }
program=$1
headers=$(readelf -hlW "$program")
dynamic=$(readelf -dW "$program")
symbols=$(readelf -sW --dyn-syms "$program")
status=0

check() {  # name, whether it holds
  echo "$1: $2"
  [[ $2 == yes ]] || status=1
}
found() { grep -qE "$1" <<<"$2" && echo yes || echo no; }

check "position-independent (PIE)" "$(found 'Type: +DYN' "$headers")"
check "stack not executable" "$(found 'GNU_STACK .* RW +0x' "$headers")"
check "relocations read-only (RELRO)" "$(found 'GNU_RELRO' "$headers")"
check "functions bound at start (BIND_NOW)" "$(found 'BIND_NOW|FLAGS_1.*NOW' "$dynamic")"
check "stacks guarded" "$(found '__stack_chk_fail' "$symbols")"
check "calls checked (_FORTIFY_SOURCE)" "$(found '_chk@' "$symbols")"
exit $status

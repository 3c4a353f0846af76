#!/usr/bin/env bash
# The display goes away: a sentence says so, the recording is whole, and no part of a file is left.
source "$(dirname "$0")/play.sh"

start 2d --record lost.rec --json lost.json
sleep 1
kill "$(jobs -p | head -1)"  # the X server
status=0
wait "$pid" || status=$?
[ "$status" = 1 ] || fail "ends with status $status"
[ "$(cat log)" = "softcell: the display of the window has gone; the demo ends here" ] || fail "it says something else"
[ -e lost.json ] && fail "statistics of half a run are left"
ls -A | grep -q partial && fail "a part of a file is left"
"$softcell" demo 2d --headless --quiet --replay lost.rec || fail "the recording is not whole"

#!/usr/bin/env bash
# Ctrl-C: one sentence says how far it came, and nothing half written is left.
source "$(dirname "$0")/play.sh"

start 2d --trace "$folder/t.json" --json "$folder/s.json"
kill -INT "$pid"
status=0
wait "$pid" || status=$?
[ "$status" = 130 ] || fail "ends with status $status when it is interrupted"
sentence='softcell: interrupted after [0-9]+ frames; only a run to its end leaves a trace, statistics or a saved scene'
grep -Eqx "$sentence" "$folder/log" && [ "$(wc -l <"$folder/log")" = 1 ] || fail "does not say how far it came"
ls "$folder" | grep -q '^[ts]\.json' && fail "an interrupted run leaves files"

# With a number of frames it closes by itself.
"$softcell" demo 2d --frames 30 --json "$folder/stats.json" >"$folder/log" 2>&1 || fail "fails with --frames"
grep -q '"frames": 30' "$folder/stats.json" || fail "not 30 frames"

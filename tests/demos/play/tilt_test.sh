#!/usr/bin/env bash
# Three dimensions: tilt, jump, look from elsewhere, back to the beginning.
source "$(dirname "$0")/play.sh"

start 3d --record "$folder/play3.rec"
xdotool keydown Right
sleep 2  # the tilt grows to its limit in a fifth of it, on a machine that keeps up
xdotool keyup Right key space
xdotool mousemove --window "$window" 320 180 mousedown 1 mousemove --window "$window" 400 165 mouseup 1
sleep 0.7
shot demo3d_tilted
xdotool key BackSpace key p
finish
for event in 'tilt 0 0 -0.35' 'push all 0 5 0' 'home all' 'pause'; do recorded "$event" play3; done
same_again 3d play3

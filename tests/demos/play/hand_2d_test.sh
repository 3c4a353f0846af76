#!/usr/bin/env bash
# Two dimensions: grab the man, drag him, throw him; gravity; views; help.
source "$(dirname "$0")/play.sh"

start 2d --record "$folder/play.rec"
xdotool mousemove --window "$window" 320 180 mousedown 1
for x in 350 380 410 440; do xdotool mousemove --window "$window" $x 100; sleep 0.1; done
shot demo2d_dragged
xdotool mouseup 1 key Up key plus key space
sleep 0.3
xdotool key v key F1
sleep 0.5
shot demo2d_help
finish
for event in 'hold user 0' 'move user' 'release user' 'gravity 0 9' 'gravity 0 10' 'push all 0 5'; do recorded "$event" play; done
same_again 2d play

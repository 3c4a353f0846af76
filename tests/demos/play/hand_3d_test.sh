#!/usr/bin/env bash
# The mouse takes a body in three dimensions, lifts it, moves it away with the wheel, and throws it.
source "$(dirname "$0")/play.sh"

start 3d --scene drop --record "$folder/hold.rec"
sleep 1
xdotool mousemove --window "$window" 320 210 mousedown 1
for y in 190 165 140 120; do xdotool mousemove --window "$window" 320 $y; sleep 0.1; done
xdotool click 4
sleep 0.5
shot demo3d_held
xdotool mousemove --window "$window" 250 100 mouseup 1
sleep 0.2
finish
for event in 'hold user 0' 'move user' 'release user'; do recorded "$event" hold; done
same_again 3d hold

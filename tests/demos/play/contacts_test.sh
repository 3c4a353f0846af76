#!/usr/bin/env bash
# In the view of contacts a click on a point takes nothing, and the menu has the contact's values.
source "$(dirname "$0")/play.sh"

size=1280x720 start 3d --scene drop --view contacts --record "$folder/contact.rec"
sleep 2
xdotool key p
sleep 0.5
# The points are red, some pixels wide: the middle of the longest row of red pixels.
import -window "$window" -depth 8 "rgb:$folder/contacts"
at=$(python3 - "$folder/contacts" <<'PYTHON'
import re, sys
pixels = open(sys.argv[1], "rb").read()
red = bytes(r > 150 and g < 60 and b < 60 for r, g, b in zip(pixels[0::3], pixels[1::3], pixels[2::3]))
longest = max(re.finditer(b"\1+", red), key=lambda run: len(run[0]), default=None)
if longest and len(longest[0]) >= 4:
    print((longest.start() + longest.end()) // 2 % 1280, longest.start() // 1280)
PYTHON
)
[ -n "$at" ] || fail "no contact is seen"
xdotool mousemove --window "$window" $at mousedown 1 mouseup 1
sleep 0.3
xdotool key m
sleep 0.7
xdotool mousemove --window "$window" 200 500
for _ in 1 2 3 4 5 6; do xdotool click 5; sleep 0.1; done
sleep 0.5
shot demo3d_contact_picked
yellow=$(convert "$shots/demo3d_contact_picked.png" -crop 869x720+411+0 -depth 8 rgb:- | python3 -c '
import sys
pixels = sys.stdin.buffer.read()
print(sum(r > 170 and g > 110 and b < 80 for r, g, b in zip(pixels[0::3], pixels[1::3], pixels[2::3])))')
((yellow > 20)) || fail "the contact that was clicked is not marked"
xdotool key m
finish
! grep -q hold "$folder/contact.rec" || fail "a click on a contact takes a body"

# Code that writes code, with the `sync` that is needed before it runs.
	.include "program.inc"
	.text
	.global	main
main:
	ori	$90, $0, 0
# 1: `il $5, n` with another n each time, 200 times.
	il	$10, 200
	il	$11, 0			# the sum of what was loaded
	il	$12, 0			# the sum of what should have been
again:
	ila	$13, patched
	shli	$14, $10, 7		# the immediate stands at bits 9 to 24
	ilhu	$15, 0x4080		# il $5, 0
	iohl	$15, 5
	or	$15, $15, $14
	store_word $15, $13
	sync
patched:
	il	$5, -1
	a	$11, $11, $5
	a	$12, $12, $10
	ai	$10, $10, -1
	brnz	$10, again
	expect_same $11, $12, 1

# 2: a function copied to where data were, and called there.
	ila	$10, square
	ila	$11, room
	lqd	$12, 0($10)
	stqd	$12, 0($11)
	sync
	il	$3, 12
	bisl	$0, $11
	expect	$3, 144, 2

# 3: another one in its place.
	ila	$10, cube
	lqd	$12, 0($10)
	stqd	$12, 0($11)
	syncc
	il	$3, 12
	ila	$11, room
	bisl	$0, $11
	expect	$3, 1728, 3
	il	$3, 0
	br	end

	.align	4
square:
	mpy	$3, $3, $3
	bi	$0
	nop
	lnop
cube:
	mpy	$4, $3, $3
	mpy	$3, $4, $3
	bi	$0
	lnop

# The calls above used $0.
end:
	bi	$90

	.data
	.align	4
room:
	.int	0, 0, 0, 0

# Indirect branches: a small machine that jumps by a table for each of its instructions, and each conditional form taken and not taken.
	.include "program.inc"
	.text
	.global	main
main:
# 1: 3 * (20 + 22) - 100 on a machine with one accumulator.
	ila	$10, bytecode
	il	$11, 0			# the accumulator
fetch:
	lqd	$12, 0($10)
	ai	$13, $10, -3		# a byte goes to the right end of the preferred word
	rotqby	$12, $12, $13
	andi	$12, $12, 255
	ai	$10, $10, 1
	shli	$12, $12, 2
	ila	$13, handlers
	a	$13, $13, $12
	load_word $14, $13
	bi	$14
operand:				# $15 = the next byte, with its sign; returns to $20
	lqd	$15, 0($10)
	ai	$16, $10, -3
	rotqby	$15, $15, $16
	xsbh	$15, $15
	xshw	$15, $15
	ai	$10, $10, 1
	bi	$20
add:
	brsl	$20, operand
	a	$11, $11, $15
	br	fetch
multiply:
	brsl	$20, operand
	mpy	$11, $11, $15
	br	fetch
done:
	expect	$11, 26, 1

# 2..9: conditional forms. A wrong way leads to `wrong`, whose status is in $79.
	il	$30, 0
	constant $31, 0x00010000	# its lower half is zero
	il	$32, 1
	ila	$33, wrong
	il	$79, 2
	ila	$34, right_2
	biz	$30, $34
	br	wrong
right_2:
	il	$79, 3
	biz	$31, $33
	binz	$30, $33
	il	$79, 4
	ila	$34, right_4
	binz	$31, $34
	br	wrong
right_4:
	il	$79, 5
	ila	$34, right_5
	bihz	$31, $34
	br	wrong
right_5:
	il	$79, 6
	bihz	$32, $33
	bihnz	$31, $33
	il	$79, 7
	ila	$34, right_7
	bihnz	$32, $34
	br	wrong
right_7:
# 8: a target's low two bits and the bits beyond the local store fall away.
	il	$79, 8
	ila	$34, right_8 + 3
	constant $35, 0xABC00000
	a	$34, $34, $35
	bi	$34
	br	wrong
right_8:
# 9: the link of bisl is the address behind it, the other words are zero.
	ila	$34, here
	il	$36, -1
	bisl	$36, $34
here:
	il	$37, 0
	ila	$38, here
	cwd	$39, 0($37)
	shufb	$38, $38, $37, $39	# the address in the preferred word alone
	expect_same $36, $38, 9
# 10: a hint changes nothing, wherever it points.
	hbrr	hinted, wrong
	hbra	hinted, wrong
	hbr	hinted, $33
	hbrp
	il	$79, 10
hinted:
	br	right_10
	br	wrong
right_10:
	il	$3, 0
	bi	$0
wrong:
	br	fail

	.section .rodata
	.align	4
handlers:
	.int	done, add, multiply, wrong
bytecode:
	.byte	1, 20, 1, 22, 2, 3, 1, -100, 0, 3, 3, 3, 3, 3, 3, 3

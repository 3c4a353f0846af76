# Loops that count, compare and sort.
	.include "program.inc"
	.text
	.global	main
main:
# 1: the sum of 1 to 1000.
	il	$10, 1000
	il	$11, 0
sum:
	a	$11, $11, $10
	ai	$10, $10, -1
	brnz	$10, sum
	expect	$11, 500500, 1

# 2: the greatest common divisor of 1071 and 462, by subtraction.
	il	$10, 1071
	il	$11, 462
divide:
	ceq	$12, $10, $11
	brnz	$12, divided
	cgt	$12, $10, $11
	brz	$12, second_larger
	sf	$10, $11, $10
	br	divide
second_larger:
	sf	$11, $10, $11
	br	divide
divided:
	expect	$10, 21, 2

# 3: a loop over a halfword: the upper half of the word does not count.
	constant $10, 0x7FFF0005
	il	$11, 0
halves:
	ai	$11, $11, 1
	ahi	$10, $10, -1
	brhnz	$10, halves
	expect	$11, 5, 3

# 4: 32 words sorted in place, each pass over one less.
	il	$10, 31
pass:
	ila	$11, numbers
	ori	$12, $10, 0
compare:
	ai	$13, $11, 4
	load_word $14, $11
	load_word $15, $13
	cgt	$16, $14, $15
	brz	$16, in_order
	store_word $15, $11
	store_word $14, $13
in_order:
	ori	$11, $13, 0
	ai	$12, $12, -1
	brnz	$12, compare
	ai	$10, $10, -1
	brnz	$10, pass
# They ascend, and none is lost.
	ila	$11, numbers
	il	$12, 31
	load_word $17, $11
ascending:
	ai	$13, $11, 4
	load_word $14, $11
	load_word $15, $13
	a	$17, $17, $15
	cgt	$16, $14, $15
	expect	$16, 0, 4
	ori	$11, $13, 0
	ai	$12, $12, -1
	brnz	$12, ascending
	expect	$17, 0x00007AAD, 5
	il	$3, 0
	bi	$0

	.data
	.align	7
numbers:
	.int	7071, -3, 0, 88, 1234, -8191, 42, 42, 9999, 17, -1, 65, 4096, 3, 2, 1
	.int	100, -100, 5555, 21, 8, 13, 5, -2, 3001, 777, 31, -64, 600, 12, 6, 6977

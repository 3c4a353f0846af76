# A list command that gathers four pieces of 64 bytes, stops behind the second, and goes on after the fourth element was changed; then a list
# that scatters them. argp: 1,024 bytes; envp: room for as many.
	.include "program.inc"
	.text
	.global	main
main:
	ori	$80, $4, 0
	ori	$81, $5, 0
	rotqbyi	$82, $80, 4		# the low words of both addresses
	rotqbyi	$83, $81, 4
	ila	$84, elements
	ila	$85, pieces
	il	$10, 64

# The elements: size and low address, at 0, 256, 512 and 768 bytes. The second stalls.
	il	$11, 0
	ori	$12, $84, 0
	ori	$13, $82, 0
make:
	store_word $10, $12
	ai	$14, $12, 4
	store_word $13, $14
	ai	$12, $12, 8
	ai	$13, $13, 256
	ai	$11, $11, 1
	ceqi	$14, $11, 4
	brz	$14, make
	constant $15, 0x80000040
	ai	$14, $84, 8
	store_word $15, $14

	wrch	$ch16, $85
	wrch	$ch17, $80
	wrch	$ch18, $84
	il	$11, 32
	wrch	$ch19, $11
	il	$11, 5
	wrch	$ch20, $11
	il	$11, 0x44		# getl
	wrch	$ch21, $11
	rdch	$12, $ch25		# waits for the stall
	expect	$12, 1 << 5, 1
	lqd	$13, 64($85)		# the second piece is there
	lqd	$14, 0($85)
	ori	$16, $13, 0
	expect	$14, 0x00000000, 2
	expect	$16, 0x00000040, 3
# The fourth piece comes from 128 bytes instead.
	ai	$13, $82, 128
	ai	$14, $84, 28
	store_word $13, $14
	il	$11, 5
	wrch	$ch26, $11
	wait_for_tags 1 << 5
	lqd	$13, 128($85)
	expect	$13, 0x00000080, 4	# each word of the data is its number
	lqd	$13, 192($85)
	expect	$13, 0x00000020, 5

# The same pieces, behind each other from envp on, in pieces of 16 bytes.
	il	$11, 0
	ori	$12, $84, 0
	ori	$13, $83, 0
	il	$10, 16
make_small:
	store_word $10, $12
	ai	$14, $12, 4
	store_word $13, $14
	ai	$12, $12, 8
	ai	$13, $13, 32
	ai	$11, $11, 1
	ceqi	$14, $11, 16
	brz	$14, make_small
	wrch	$ch16, $85
	wrch	$ch17, $81
	wrch	$ch18, $84
	il	$11, 128
	wrch	$ch19, $11
	il	$11, 6
	wrch	$ch20, $11
	il	$11, 0x24		# putl
	wrch	$ch21, $11
	wait_for_tags 1 << 6
	il	$3, 0
	bi	$0

	.section .bss, "aw", @nobits
	.align	7
elements:
	.space	128
pieces:
	.space	256

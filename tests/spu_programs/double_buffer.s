# out[i] = 3 * in[i] + 7 for words, in blocks of 1,024 bytes through two buffers. argp: { u64 in, u64 out, u32 blocks } in 32 bytes.
#
#   get   [0 A][1 B]     [2 A]
#   work       [0 A]     [1 B]
#   put             [0 A]     [1 B]     the next get into a buffer is fenced behind its put
	.include "program.inc"
	.text
	.global	main
main:
	ori	$90, $0, 0
	ila	$80, parameters
	dma_command $80, $4, 32, 31, 0x40
	constant $73, 1 << 31
	wrch	$ch22, $73
	il	$73, 2
	wrch	$ch23, $73
	rdch	$74, $ch24
	lqd	$81, 0($80)		# in, out
	lqd	$82, 16($80)		# blocks
	brz	$82, nothing
	ori	$83, $81, 0		# where the next get reads
	rotqbyi	$84, $81, 8		# and the next put writes
	il	$85, 0			# the buffer of the block in work: its tag
	il	$86, 1
	brsl	$0, fetch
block:
# The next block's get, if there is one.
	ceqi	$10, $82, 1
	brnz	$10, work
	xori	$85, $85, 1
	brsl	$0, fetch
	xori	$85, $85, 1
work:
	shl	$73, $86, $85
	wrch	$ch22, $73
	il	$73, 2
	wrch	$ch23, $73
	rdch	$74, $ch24
	ila	$10, buffers
	shli	$11, $85, 10
	a	$10, $10, $11
	il	$11, 64
compute:
	lqd	$12, 0($10)
	shli	$13, $12, 1
	a	$13, $13, $12
	ai	$13, $13, 7
	stqd	$13, 0($10)
	ai	$10, $10, 16
	ai	$11, $11, -1
	brnz	$11, compute
# put with the same tag.
	il	$11, 1024
	sf	$10, $11, $10
	wrch	$ch16, $10
	wrch	$ch17, $84
	rotqbyi	$12, $84, 4
	wrch	$ch18, $12
	il	$13, 1024
	wrch	$ch19, $13
	wrch	$ch20, $85
	il	$13, 0x20
	wrch	$ch21, $13
	rotqbyi	$12, $84, 4
	il	$15, 1024
	a	$12, $12, $15
	rotqbyi	$12, $12, 12		# the low word back into its place
	fsmbi	$14, 0x0F00
	selb	$84, $84, $12, $14
	xori	$85, $85, 1
	ai	$82, $82, -1
	brnz	$82, block
	wait_for_tags 3
nothing:
	il	$3, 0
	bi	$90

# Gets the next block into the buffer $85, behind what was put from it.
fetch:
	ila	$10, buffers
	shli	$11, $85, 10
	a	$10, $10, $11
	wrch	$ch16, $10
	wrch	$ch17, $83
	rotqbyi	$12, $83, 4
	wrch	$ch18, $12
	il	$13, 1024
	wrch	$ch19, $13
	wrch	$ch20, $85
	il	$13, 0x42		# getf
	wrch	$ch21, $13
	il	$15, 1024
	a	$12, $12, $15
	rotqbyi	$12, $12, 12
	fsmbi	$14, 0x0F00
	selb	$83, $83, $12, $14
	bi	$0

	.section .bss, "aw", @nobits
	.align	7
parameters:
	.space	128
buffers:
	.space	2048

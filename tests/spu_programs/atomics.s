# Raises the word at argp, envp times, by getllar and putllc; others may do the same meanwhile.
	.include "program.inc"
	.text
	.global	main
main:
	rotqbyi	$80, $5, 4		# how often
	ori	$81, $4, 0		# the effective address
	ila	$82, line
again:
	dma_command $82, $81, 128, 0, 0xD0
	rdch	$10, $ch27
	expect	$10, 4, 1		# getllar is done
	lqd	$11, 0($82)
	ai	$12, $11, 1
	cwd	$13, 0($82)
	shufb	$11, $12, $11, $13
	stqd	$11, 0($82)
	dma_command $82, $81, 128, 0, 0xB4
	rdch	$10, $ch27
	brz	$10, stored
	expect	$10, 1, 2		# the reservation was lost
	br	again
stored:
	ai	$80, $80, -1
	brnz	$80, again
	il	$3, 0
	bi	$0

	.section .bss, "aw", @nobits
	.align	7
line:
	.space	128

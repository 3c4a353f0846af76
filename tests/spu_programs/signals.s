# Two SPEs send each other a count by sndsig, each one more than it got. argp: the effective address of the other's signal register 1; envp: 1 if
# this one begins. Ends at 20; the register reads as empty then.
	.include "program.inc"
	.text
	.global	main
main:
	ori	$80, $4, 0
	rotqbyi	$81, $5, 4
	ila	$82, message		# the low four bits of both addresses must be the same: 0xC
	il	$83, 0
	brnz	$81, send
receive:
	rdch	$83, $ch3
	cgti	$10, $83, 18
	brnz	$10, last
send:
	ai	$83, $83, 1
	store_word $83, $82
	dma_command $82, $80, 4, 0, 0xA0
	wait_for_tags 1
	cgti	$10, $83, 18
	brz	$10, receive
last:
	rchcnt	$10, $ch3
	expect	$10, 0, 1
	cgti	$10, $83, 20		# 19 was received, 20 is not sent by anybody else
	expect	$10, 0, 2
	il	$3, 0
	bi	$0

	.data
	.align	4
	.int	0, 0, 0
message:
	.int	0

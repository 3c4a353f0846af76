# Interrupts by the inbound mailbox: the handler at address 0 sums what arrives; the main program only waits.
	.include "program.inc"

# $100: events, $102: sum, $103: words, $104: machine status, $105: all that it ever was in here, $106: whence it came
	.section .interrupt, "ax", @progbits
handler:
	rdch	$100, $ch0
	wrch	$ch2, $100		# acknowledged before the mailbox is drained
	rdch	$104, $ch13
	or	$105, $105, $104
	rdch	$106, $ch15
drain:
	rchcnt	$107, $ch29
	brz	$107, drained
	rdch	$101, $ch29
	a	$102, $102, $101
	ai	$103, $103, 1
	br	drain
drained:
	irete

	.text
	.global	main
main:
	il	$102, 0
	il	$103, 0
	il	$105, 0
	il	$10, 0x10		# the mailbox's event
	wrch	$ch1, $10
	rdch	$11, $ch11
	expect	$11, 0x10, 1
	wrch	$ch28, $10		# tells the PPU side to begin
	ila	$12, wait
	bie	$12
wait:
	ceqi	$13, $103, 6
	brz	$13, wait
	ila	$12, waited
	bid	$12
waited:
	expect	$102, 21, 2
	expect	$105, 0, 3		# the handler ran with interrupts disabled
	rdch	$14, $ch13
	expect	$14, 0, 4
	ila	$15, wait		# it came from the loop, which is at most 3 instructions
	sf	$16, $15, $106
	clgti	$16, $16, 12
	expect	$16, 0, 5
# A branch that is taken if an event is there, and links in any case: none is.
	ila	$17, wrong
	il	$18, 0
	bisled	$18, $17
linked:
	ila	$19, linked
	ceq	$20, $18, $19
	expect	$20, -1, 6
# The PPU side sends one more when it hears of it: now there is an event.
	wrch	$ch28, $10
	rdch	$21, $ch0
	expect	$21, 0x10, 7
	wrch	$ch1, $10		# the same mask again: the event still waits to be acknowledged
	ila	$17, seen
	bisled	$18, $17
wrong:
	il	$79, 8
	br	fail
seen:
	il	$3, 0
	bi	$0

// setjmp and longjmp: the registers that a call keeps, the stack pointer and the place behind the call.  [x86-64 psABI, registers]
// documented

asm(R"(
        .section .text.setjmp, "ax", @progbits
        .p2align 4
        .globl  setjmp
        .hidden setjmp
        .type   setjmp, @function
setjmp:
        movl    %edi, %edi              # a pointer of 32 bits
        movq    %rbx, 0(%rdi)
        movq    %rbp, 8(%rdi)
        movq    %r12, 16(%rdi)
        movq    %r13, 24(%rdi)
        movq    %r14, 32(%rdi)
        movq    %r15, 40(%rdi)
        leaq    8(%rsp), %rax
        movq    %rax, 48(%rdi)
        movq    (%rsp), %rax
        movq    %rax, 56(%rdi)
        xorl    %eax, %eax
        ret
        .size   setjmp, . - setjmp

        .section .text.longjmp, "ax", @progbits
        .p2align 4
        .globl  longjmp
        .hidden longjmp
        .type   longjmp, @function
longjmp:
        movl    %edi, %edi
        movl    $1, %eax                # what setjmp returns for a value of 0
        testl   %esi, %esi
        cmovnel %esi, %eax
        movq    0(%rdi), %rbx
        movq    8(%rdi), %rbp
        movq    16(%rdi), %r12
        movq    24(%rdi), %r13
        movq    32(%rdi), %r14
        movq    40(%rdi), %r15
        movq    48(%rdi), %rsp
        jmpq    *56(%rdi)
        .size   longjmp, . - longjmp
        .text
)");

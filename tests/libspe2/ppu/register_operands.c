/* Loads from problem state that are operands of other instructions, as optimising compilers make them: each gives what it gives of ordinary
 * memory, with all its flags. Then one that reads and writes, which ends the program with a sentence. */
#include "run_in_thread.h"

typedef struct {
  unsigned long long value;
  unsigned char carry, parity, zero, sign, overflow;
} result_t;

#define FLAGS "\n\tsetc %[c]\n\tsetp %[p]\n\tsetz %[z]\n\tsets %[s]\n\tseto %[o]"
#define DEFINE(name, instruction)                                                                   \
  static result_t name(volatile unsigned int* memory, unsigned int operand) {                       \
    result_t r;                                                                                     \
    r.value = 0xABCDEF0100000000ull | operand;                                                      \
    __asm__ volatile(instruction FLAGS                                                              \
                     : [v] "+&r"(r.value), [c] "=m"(r.carry), [p] "=m"(r.parity), [z] "=m"(r.zero), \
                       [s] "=m"(r.sign), [o] "=m"(r.overflow)                                       \
                     : [m] "m"(*memory)                                                             \
                     : "cc", "r12", "memory");                                                      \
    return r;                                                                                       \
  }
#define FORMS(X)                                          \
  X(add, "addl %[m], %k[v]")                              \
  X(or, "orl %[m], %k[v]")                                \
  X(and, "andl %[m], %k[v]")                              \
  X(subtract, "subl %[m], %k[v]")                         \
  X(xor, "xorl %[m], %k[v]")                              \
  X(compare_register, "cmpl %[m], %k[v]")                 \
  X(compare_memory, "cmpl %k[v], %[m]")                   \
  X(compare_byte, "cmpl $-7, %[m]")                       \
  X(compare_constant, "cmpl $0x12345678, %[m]")           \
  X(test_register, "testl %k[v], %[m]")                   \
  X(test_constant, "testl $0x80000001, %[m]")             \
  X(load, "movl %[m], %k[v]\n\ttestl %k[v], %k[v]")       \
  X(load_signed, "movslq %[m], %[v]\n\ttestq %[v], %[v]") \
  X(high_register, "movl %k[v], %%r12d\n\taddl %[m], %%r12d\n\tmovl %%r12d, %k[v]")
FORMS(DEFINE)

#define ENTRY(name, instruction) {#name, name},
static const struct {
  const char* name;
  result_t (*go)(volatile unsigned int* memory, unsigned int operand);
} forms[] = {FORMS(ENTRY)};

int main(int argc, char** argv) {
  static const unsigned int values[] = {0,          1,          7,          0x12345678, 0x7FFFFFFF,
                                        0x80000000, 0x80000001, 0xFFFFFFF9, 0xFFFFFFFF};
  enum { COUNT = sizeof values / sizeof values[0] };
  spe_context_ptr_t spe = spe_context_create(SPE_MAP_PS, NULL);
  volatile spe_mfc_command_area_t* mfc =
      (volatile spe_mfc_command_area_t*)spe_ps_area_get(spe, SPE_MFC_COMMAND_AREA);
  unsigned int form, i, j;
  (void)argv;
  for (form = 0; form < sizeof forms / sizeof forms[0]; ++form) {
    for (i = 0; i < COUNT; ++i) {
      for (j = 0; j < COUNT; ++j) {
        volatile unsigned int memory = values[i];
        result_t expected = forms[form].go(&memory, values[j]), found;
        mfc->Prxy_QueryMask = values[i];
        found = forms[form].go(&mfc->Prxy_QueryMask, values[j]);
        if (found.value != expected.value || found.carry != expected.carry ||
            found.parity != expected.parity || found.zero != expected.zero || found.sign != expected.sign ||
            found.overflow != expected.overflow) {
          printf("%s of %x and %x differs\n", forms[form].name, values[i], values[j]);
          return 1;
        }
      }
    }
  }
  puts("ok");
  fflush(stdout);
  if (argc > 1) __asm__ volatile("orl $1, %0" : "+m"(mfc->Prxy_QueryMask) : : "cc");
  return 0;
}

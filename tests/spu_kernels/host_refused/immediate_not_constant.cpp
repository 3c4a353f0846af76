// refused: not a constant expression|no matching function for call to 'immediate_words
#include <spu_intrinsics.h>
qword f(qword a, int n) { return si_ai(a, n); }

// Includes itself anew each time, as NDEBUG may have changed. [C17, 7.2]
#include <sys/cdefs.h>

#undef assert
#ifdef NDEBUG
#define assert(condition) ((void)0)
#else
#define assert(condition) \
  ((condition) ? (void)0 : softcell_assertion_failed(#condition, __FILE__, __LINE__, __func__))
#endif
#if !defined(__cplusplus) && !defined(static_assert)
#define static_assert _Static_assert
#endif

__BEGIN_DECLS
void softcell_assertion_failed(const char* condition, const char* file, int line, const char* function)
    __attribute__((noreturn));
__END_DECLS

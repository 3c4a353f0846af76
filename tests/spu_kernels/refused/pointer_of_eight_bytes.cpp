// refused: static.?assert
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Node {
  Node* next;
  uint32_t value;
};
static_assert(sizeof(Node) == 16, "on the host only");

// A program in C++ whose static objects end with it, the last made first; then it asks for more memory than there is.
#include <cstdio>
#include <cstdlib>

namespace {

struct Speaks {
  explicit Speaks(const char* what) : name(what) { std::printf("%s is made\n", name); }
  ~Speaks() { std::printf("%s ends\n", name); }
  const char* name;
};
Speaks first("first"), second("second");
/// As many as have no room in a table.
struct Counts {
  ~Counts() {
    if (++ended == 100) std::printf("a hundred end\n");
  }
  static int ended;
};
int Counts::ended;
template <int count>
void make() {
  static Counts one;
  if constexpr (count > 1) make<count - 1>();
}

__attribute__((destructor)) void end_late() { std::printf("the first destructor function\n"); }
__attribute__((destructor)) void end_early() { std::printf("the last destructor function\n"); }

}  // namespace

int main(unsigned long long, unsigned long long wants_too_much) {
  static Speaks third("third");
  make<100>();
  std::atexit([] { std::printf("atexit\n"); });
  if (wants_too_much == 0) return 0;
  char* volatile block = new char[0x40000];
  return block[0];
}

#define LIMIT 8192
typedef struct {
  unsigned long long in, out;
  unsigned int in_bytes, pad[3];
} order_t;

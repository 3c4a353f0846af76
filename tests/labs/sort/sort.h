#define SPES 4
#define BLOCK 512
typedef struct {
  unsigned long long numbers;
  unsigned long long counter; /* address of a word on a line of its own */
  unsigned int pad[28];
} control_t;

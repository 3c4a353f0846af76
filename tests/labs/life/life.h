#define BANDS 4
#define ROWS 8
#define COLUMNS 32
#define STEPS 10
typedef struct {
  unsigned long long cells, above, below, above_signal, below_signal;
  unsigned int pad[2];
} band_t;

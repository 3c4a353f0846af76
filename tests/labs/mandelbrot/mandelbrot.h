typedef struct {
  unsigned long long image; /* rows of WIDTH bytes */
  float x0, y0, step;
  unsigned int first_row, row_stride, rows;
  unsigned int pad[4];
} params_t;
#define WIDTH 128
#define HEIGHT 64
#define MAX_ITER 100

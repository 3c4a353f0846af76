#define POINTS 1024
#define CLUSTERS 4
typedef struct {
  float x[CLUSTERS], y[CLUSTERS];
} centres_t;
typedef struct {
  float sum_x[CLUSTERS], sum_y[CLUSTERS];
  unsigned int count[CLUSTERS];
  unsigned int pad[20];
} part_t; /* one line for each SPE */
typedef struct {
  unsigned long long xs, ys, centres, parts;
} problem_t;

#define BODIES 128
typedef struct {
  float x, y, z, mass;
} body_t;
typedef struct {
  float x, y, z, pad;
} vec_t;
typedef struct {
  unsigned long long bodies, forces;
  unsigned int first, count, pad[2];
} job_t;

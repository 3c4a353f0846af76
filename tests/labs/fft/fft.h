#define POINTS 256

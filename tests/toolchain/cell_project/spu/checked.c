#include "times.h"
int is_right(unsigned int sum, unsigned int factor, unsigned int product) { return times(factor, sum) == product && times(sum, 2) == sum + sum; }

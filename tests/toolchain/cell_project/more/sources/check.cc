#include <cstdio>
int main() { std::puts("checked"); }

#ifdef __cplusplus
extern "C" {
#endif
void fetch(void* ls, unsigned long long ea, unsigned bytes);
void store(void* ls, unsigned long long ea, unsigned bytes);
void scale(float* numbers, unsigned count);
#ifdef __cplusplus
}
#endif

#pragma once
// Memory and strings in the local store. [C17, 7.24; POSIX]

#include <stddef.h>
#include <sys/cdefs.h>

__BEGIN_DECLS
void* memcpy(void* to, const void* from, size_t bytes);
void* memmove(void* to, const void* from, size_t bytes);
void* memset(void* to, int value, size_t bytes);
int memcmp(const void* a_, const void* b_, size_t bytes);
void* memchr(const void* in, int value, size_t bytes);
size_t strlen(const char* s_);
size_t strnlen(const char* s_, size_t most);
char* strcpy(char* to, const char* from);
char* strncpy(char* to, const char* from, size_t most);
char* strcat(char* to, const char* from);
char* strncat(char* to, const char* from, size_t most);
int strcmp(const char* a_, const char* b_);
int strncmp(const char* a_, const char* b_, size_t most);
int strcasecmp(const char* a_, const char* b_);
int strncasecmp(const char* a_, const char* b_, size_t most);
char* strchr(const char* s_, int c_);
char* strrchr(const char* s_, int c_);
char* strstr(const char* s_, const char* part);
size_t strspn(const char* s_, const char* these);
size_t strcspn(const char* s_, const char* these);
char* strpbrk(const char* s_, const char* these);
char* strtok(char* s_, const char* separators);
char* strtok_r(char* s_, const char* separators, char** rest);
char* strdup(const char* s_);
char* strndup(const char* s_, size_t most);
/// @return  the end of the copy
char* stpcpy(char* to, const char* from);
char* strsep(char** rest, const char* separators);
/// @return  behind what was written
void* mempcpy(void* to, const void* from, size_t bytes);
/// Copies up to a character, which it copies, too. @return  behind the copy of that character, or null
void* memccpy(void* to, const void* from, int c_, size_t most);
/// Copies and appends what there is room for, always with a zero behind. @return  the length that needs no more room
size_t strlcpy(char* to, const char* from, size_t room);
size_t strlcat(char* to, const char* from, size_t room);
void bzero(void* to, size_t bytes);
void bcopy(const void* from, void* to, size_t bytes);
/// Of a number in errno.h.
char* strerror(int error);
__END_DECLS

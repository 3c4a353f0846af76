/* time.h: the calendar, and a clock that goes forward. */
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "check.h"

static void calendar(void) {
  const time_t billion = 1000000000, leap = 951782400, old = -1, first = 0;
  struct tm t;
  char text[160];
  CHECK(gmtime_r(&billion, &t)->tm_year == 101 && t.tm_mon == 8 && t.tm_mday == 9 && t.tm_wday == 0 && t.tm_yday == 251);
  CHECK(t.tm_hour == 1 && t.tm_min == 46 && t.tm_sec == 40 && mktime(&t) == billion);
  CHECK(strftime(text, sizeof text, "%a %A %b %B %d %e %H:%M:%S %I %p %j %y %Y %m %u %w %U %W %%", &t) > 0);
  CHECK(strcmp(text, "Sun Sunday Sep September 09  9 01:46:40 01 AM 252 01 2001 09 7 0 36 36 %") == 0);
  CHECK(strftime(text, sizeof text, "%c|%D|%F|%T|%R|%r|%x|%X|%C|%h|%n|%t|%z|%Z", &t) > 0);
  CHECK(strcmp(text, "Sun Sep  9 01:46:40 2001|09/09/01|2001-09-09|01:46:40|01:46|01:46:40 AM|09/09/01|01:46:40|20|Sep|"
                     "\n|\t|+0000|UTC") == 0);
  CHECK(strftime(text, sizeof text, "%G-W%V %g", &t) > 0 && strcmp(text, "2001-W36 01") == 0);
  t.tm_year = 127, t.tm_mon = 0, t.tm_mday = 1; /* a Friday */
  CHECK(mktime(&t) > 0 && strftime(text, sizeof text, "%G-W%V", &t) > 0 && strcmp(text, "2026-W53") == 0);
  t.tm_year = 124, t.tm_mon = 11, t.tm_mday = 30; /* a Monday */
  CHECK(mktime(&t) > 0 && strftime(text, sizeof text, "%G-W%V %g", &t) > 0 && strcmp(text, "2025-W01 25") == 0);
  gmtime_r(&billion, &t);
  CHECK(strftime(text, 4, "%Y", &t) == 0 && strftime(text, 5, "%Y", &t) == 4);
  CHECK(strcmp(asctime(&t), "Sun Sep  9 01:46:40 2001\n") == 0 && strcmp(ctime(&first), "Thu Jan  1 00:00:00 1970\n") == 0);
  CHECK(strcmp(asctime_r(&t, text), asctime(&t)) == 0 && localtime_r(&leap, &t)->tm_mday == 29);
  CHECK(gmtime(&leap)->tm_mon == 1 && gmtime(&leap)->tm_mday == 29);
  CHECK(localtime(&old)->tm_year == 69 && localtime(&old)->tm_sec == 59 && localtime(&old)->tm_wday == 3);
  memset(&t, 0, sizeof t);
  t.tm_year = 99, t.tm_mon = 14, t.tm_mday = 31; /* 31 March 2000 */
  CHECK(mktime(&t) == 954460800 && t.tm_mon == 2 && t.tm_year == 100 && difftime(5, 3) == 2.0);
}

static void clocks(void) {
  const clock_t begin = clock();
  struct timeval before, after;
  const struct timespec nap = {0, 1000000};
  time_t now;
  gettimeofday(&before, NULL);
  CHECK(time(&now) == now && now > 1600000000 && now >= before.tv_sec);
  CHECK(usleep(2000) == 0 && nanosleep(&nap, NULL) == 0);
  gettimeofday(&after, NULL);
  CHECK((after.tv_sec - before.tv_sec) * 1000000 + after.tv_usec - before.tv_usec >= 2000);
  CHECK(clock() - begin >= 2000 && sleep(0) == 0);
}

int main(void) {
  calendar();
  clocks();
  exit(failures);
}

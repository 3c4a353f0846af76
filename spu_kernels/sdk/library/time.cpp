// time.h and sys/time.h: the clock is the PPU side's, the calendar UTC.

#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "assist.h"

using namespace softcell_library;

namespace {

constexpr long kSecondsOfDay = 86400;
const char kDays[] = "Sunday\0   Monday\0   Tuesday\0  Wednesday\0Thursday\0 Friday\0   Saturday\0 ";
const char kMonths[] =
    "January\0  February\0 March\0    April\0    May\0      June\0     July\0     August\0   "
    "September\0October\0  "
    "November\0 December\0 ";
constexpr int kNameBytes = 10;

const char* day_name(const struct tm& t) {
  return kDays + kNameBytes * (static_cast<unsigned>(t.tm_wday) % 7);
}
const char* month_name(const struct tm& t) {
  return kMonths + kNameBytes * (static_cast<unsigned>(t.tm_mon) % 12);
}

bool is_leap(long year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

/// Days from 1 January 1970 to the first of a month of the Gregorian calendar. @param month  0..11
long days_before(long year, int month) {
  static const short kBefore[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  const long y = year - 1;
  // Leap years up to the year before, of any sign.
  const auto floor_of = [](long a, long b) { return a >= 0 ? a / b : -((b - 1 - a) / b); };
  const long leaps = floor_of(y, 4) - floor_of(y, 100) + floor_of(y, 400) - 477;
  return (year - 1970) * 365 + leaps + kBefore[month] + (month > 1 && is_leap(year) ? 1 : 0);
}

/// A week of ISO 8601, which belongs to the year of its Thursday.
struct Week {
  int year, number;
};
Week week_of(const struct tm& t) {
  int year = t.tm_year + 1900, thursday = t.tm_yday - (t.tm_wday + 6) % 7 + 3;
  const auto days_of = [](int y) { return is_leap(y) ? 366 : 365; };
  if (thursday < 0) {
    thursday += days_of(--year);
  } else if (thursday >= days_of(year)) {
    thursday -= days_of(year++);
  }
  return {year, thursday / 7 + 1};
}

/// What a conversion of strftime() writes. @return  its format for snprintf, and the number; null: it is a text, or none.
int write_part(char* to, size_t bytes, char kind, const struct tm& t) {
  const int twelve = t.tm_hour % 12 == 0 ? 12 : t.tm_hour % 12;
  switch (kind) {
    case 'a':
      return snprintf(to, bytes, "%.3s", day_name(t));
    case 'A':
      return snprintf(to, bytes, "%s", day_name(t));
    case 'b':
    case 'h':
      return snprintf(to, bytes, "%.3s", month_name(t));
    case 'B':
      return snprintf(to, bytes, "%s", month_name(t));
    case 'c':
      return snprintf(to, bytes, "%.3s %.3s %2d %02d:%02d:%02d %d", day_name(t), month_name(t), t.tm_mday,
                      t.tm_hour, t.tm_min, t.tm_sec, t.tm_year + 1900);
    case 'C':
      return snprintf(to, bytes, "%02d", (t.tm_year + 1900) / 100);
    case 'd':
      return snprintf(to, bytes, "%02d", t.tm_mday);
    case 'D':
    case 'x':
      return snprintf(to, bytes, "%02d/%02d/%02d", t.tm_mon + 1, t.tm_mday, t.tm_year % 100);
    case 'e':
      return snprintf(to, bytes, "%2d", t.tm_mday);
    case 'F':
      return snprintf(to, bytes, "%d-%02d-%02d", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday);
    case 'H':
      return snprintf(to, bytes, "%02d", t.tm_hour);
    case 'I':
      return snprintf(to, bytes, "%02d", twelve);
    case 'j':
      return snprintf(to, bytes, "%03d", t.tm_yday + 1);
    case 'm':
      return snprintf(to, bytes, "%02d", t.tm_mon + 1);
    case 'M':
      return snprintf(to, bytes, "%02d", t.tm_min);
    case 'n':
      return snprintf(to, bytes, "\n");
    case 'p':
      return snprintf(to, bytes, t.tm_hour < 12 ? "AM" : "PM");
    case 'r':
      return snprintf(to, bytes, "%02d:%02d:%02d %s", twelve, t.tm_min, t.tm_sec,
                      t.tm_hour < 12 ? "AM" : "PM");
    case 'R':
      return snprintf(to, bytes, "%02d:%02d", t.tm_hour, t.tm_min);
    case 'S':
      return snprintf(to, bytes, "%02d", t.tm_sec);
    case 't':
      return snprintf(to, bytes, "\t");
    case 'T':
    case 'X':
      return snprintf(to, bytes, "%02d:%02d:%02d", t.tm_hour, t.tm_min, t.tm_sec);
    case 'u':
      return snprintf(to, bytes, "%d", t.tm_wday == 0 ? 7 : t.tm_wday);
    case 'U':
      return snprintf(to, bytes, "%02d", (t.tm_yday + 7 - t.tm_wday) / 7);
    case 'G':
      return snprintf(to, bytes, "%d", week_of(t).year);
    case 'g':
      return snprintf(to, bytes, "%02d", week_of(t).year % 100);
    case 'V':
      return snprintf(to, bytes, "%02d", week_of(t).number);
    case 'w':
      return snprintf(to, bytes, "%d", t.tm_wday);
    case 'W':
      return snprintf(to, bytes, "%02d", (t.tm_yday + 7 - (t.tm_wday + 6) % 7) / 7);
    case 'y':
      return snprintf(to, bytes, "%02d", t.tm_year % 100);
    case 'Y':
      return snprintf(to, bytes, "%d", t.tm_year + 1900);
    case 'z':
      return snprintf(to, bytes, "+0000");
    case 'Z':
      return snprintf(to, bytes, "UTC");
    default:
      return snprintf(to, bytes, "%c", kind);
  }
}

}  // namespace

extern "C" {

int gettimeofday(struct timeval* now, void*) { return call(kGettimeofday, now, 0); }

time_t time(time_t* also) {
  struct timeval now = {0, 0};
  gettimeofday(&now, nullptr);
  if (also != nullptr) *also = now.tv_sec;
  return now.tv_sec;
}

clock_t clock() {
  static bool is_running;
  static struct timeval begin;
  struct timeval now = {0, 0};
  gettimeofday(&now, nullptr);
  if (!is_running) begin = now;
  is_running = true;
  return (now.tv_sec - begin.tv_sec) * CLOCKS_PER_SEC + (now.tv_usec - begin.tv_usec);
}

double difftime(time_t later, time_t earlier) {
  return static_cast<double>(later) - static_cast<double>(earlier);
}

struct tm* gmtime_r(const time_t* when, struct tm* t) {
  long day = *when / kSecondsOfDay, second = *when % kSecondsOfDay;
  if (second < 0) {
    second += kSecondsOfDay;
    --day;
  }
  long year = 1970 + day / 366;
  if (day < 0) year -= 2;
  while (days_before(year + 1, 0) <= day) ++year;
  while (days_before(year, 0) > day) --year;
  int month = 11;
  while (days_before(year, month) > day) --month;
  *t = {};
  t->tm_sec = static_cast<int>(second % 60);
  t->tm_min = static_cast<int>(second / 60 % 60);
  t->tm_hour = static_cast<int>(second / 3600);
  t->tm_mday = static_cast<int>(day - days_before(year, month) + 1);
  t->tm_mon = month;
  t->tm_year = static_cast<int>(year - 1900);
  t->tm_wday = static_cast<int>(((day + 4) % 7 + 7) % 7);  // 1 January 1970 was a Thursday
  t->tm_yday = static_cast<int>(day - days_before(year, 0));
  return t;
}
struct tm* localtime_r(const time_t* when, struct tm* t) {
  return gmtime_r(when, t);
}
struct tm* gmtime(const time_t* when) {
  static struct tm t;
  return gmtime_r(when, &t);
}
struct tm* localtime(const time_t* when) {
  return gmtime(when);
}

time_t mktime(struct tm* t) {
  long year = t->tm_year + 1900L + t->tm_mon / 12;
  int month = t->tm_mon % 12;
  if (month < 0) {
    month += 12;
    --year;
  }
  const long day = days_before(year, month) + t->tm_mday - 1;
  const time_t when = day * kSecondsOfDay + t->tm_hour * 3600L + t->tm_min * 60L + t->tm_sec;
  gmtime_r(&when, t);
  return when;
}

size_t strftime(char* to, size_t bytes, const char* format, const struct tm* t) {
  size_t used = 0;
  for (; *format != '\0'; ++format) {
    char part[40];
    int length = 1;
    if (*format == '%' && format[1] != '\0')
      length = write_part(part, sizeof part, *++format, *t);
    else
      part[0] = *format;
    if (length < 0 || used + static_cast<size_t>(length) >= bytes) return 0;
    memcpy(to + used, part, static_cast<size_t>(length));
    used += static_cast<size_t>(length);
  }
  if (bytes == 0) return 0;
  to[used] = '\0';
  return used;
}
char* asctime_r(const struct tm* t, char* to) { return strftime(to, 26, "%c\n", t) == 0 ? nullptr : to; }
char* asctime(const struct tm* t) {
  static char text[26];
  return asctime_r(t, text);
}
char* ctime(const time_t* when) { return asctime(gmtime(when)); }

int nanosleep(const struct timespec* wanted, struct timespec* left) { return call(kNanosleep, wanted, left); }
unsigned int sleep(unsigned int seconds) {
  struct timespec wanted = {static_cast<time_t>(seconds), 0}, left = {0, 0};
  return nanosleep(&wanted, &left) == 0 ? 0 : static_cast<unsigned int>(left.tv_sec);
}
int usleep(unsigned int microseconds) {
  const struct timespec wanted = {static_cast<time_t>(microseconds / 1000000),
                                  static_cast<long>(microseconds % 1000000 * 1000)};
  return nanosleep(&wanted, nullptr);
}

}  // extern "C"

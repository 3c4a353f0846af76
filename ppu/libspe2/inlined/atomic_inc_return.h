#pragma once
#include <libsync.h>

#pragma once

/// How often operator new was called in this program, by any thread.
long allocation_count();

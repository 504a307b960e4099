// Nothing of its own: its precompiled header is that of all tests.
#include <gtest/gtest.h>

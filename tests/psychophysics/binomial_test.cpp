#include <kerf/psychophysics/binomial.h>
#include <gtest/gtest.h>
TEST(Binomial, IsThere) { EXPECT_TRUE(true); }

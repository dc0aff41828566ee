#include "ros/certificate_record.h"

#include <gtest/gtest.h>

#include <limits>

namespace virtual_work_dynamics {
namespace {

Certificates certificates(double power, double force, double moment) {
  Certificates result;
  result.power = power;
  result.ground_force = force;
  result.ground_moment = moment;
  return result;
}

TEST(CertificateRecord, HoldsTheLargestOfEachKindUntilTaken) {
  CertificateRecord record;
  EXPECT_FALSE(record.take());
  record.record(certificates(1e-15, 3e-15, 0));
  record.record(certificates(2e-15, 1e-15, 0));
  const auto taken = record.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->power, 2e-15);
  EXPECT_EQ(taken->ground_force, 3e-15);
  EXPECT_EQ(taken->ground_moment, 0);
  EXPECT_FALSE(record.take());
  record.record(certificates(0, 0, 0));
  EXPECT_TRUE(record.take());
}

TEST(CertificateRecord, NotANumberIsLargerThanAnyNumber) {
  CertificateRecord record;
  record.record(certificates(1e-15, std::numeric_limits<double>::quiet_NaN(), 0));
  record.record(certificates(1e-15, 1e300, 0));
  const auto taken = record.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->power, 1e-15);
  EXPECT_EQ(taken->ground_force, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace virtual_work_dynamics

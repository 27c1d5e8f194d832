#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/device.h"
#include "kerf/drivers/protocols/net_ft.h"
#include "kerf/drivers/streaming_force_sensor.h"

namespace kerf::drivers {
namespace {

using net_ft::Box;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(NetFtProtocol, RequestsAreEightBytesBigEndian) {
  EXPECT_THAT(net_ft::request(net_ft::Command::start, 0),
              ElementsAre(0x12, 0x34, 0x00, 0x02, 0x00, 0x00, 0x00, 0x00));
  EXPECT_THAT(net_ft::request(net_ft::Command::bias, 255),
              ElementsAre(0x12, 0x34, 0x00, 0x42, 0x00, 0x00, 0x00, 0xFF));
  EXPECT_THAT(net_ft::request(net_ft::Command::period, 0x01020304),
              ElementsAre(0x12, 0x34, 0x00, 0x82, 0x01, 0x02, 0x03, 0x04));
}

TEST(NetFtProtocol, ARecordIsThreeCountsAndSixSignedOnes) {
  const std::vector<std::uint8_t> bytes{
      0x00, 0x00, 0x00, 0x07, 0x80, 0x00, 0x00, 0x1C, 0x80, 0x01, 0x00, 0x00,  //
      0x00, 0x0F, 0x42, 0x40, 0xFF, 0xF0, 0xBD, 0xC0, 0x7F, 0xFF, 0xFF, 0xFF,  //
      0x80, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0xFF, 0xFF, 0xFF, 0xFF};
  const auto record = net_ft::parse_record(bytes);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->rdt_sequence, 7U);
  EXPECT_EQ(record->ft_sequence, 0x8000001CU);
  EXPECT_EQ(record->status, 0x80010000U);
  EXPECT_THAT(record->counts, ElementsAre(1'000'000, -1'000'000, 2147483647, -2147483648LL, 1, -1));
}

TEST(NetFtProtocol, ARecordHasThirtySixBytesAndNoOther) {
  for (const std::size_t size : {0U, 8U, 35U, 37U, 72U})
    EXPECT_FALSE(net_ft::parse_record(std::vector<std::uint8_t>(size))) << size;
}

TEST(NetFtProtocol, StatusOfANetFtTellsOverloadFromErrorsAndFromALatch) {
  EXPECT_EQ(net_ft::health_of(Box::ati, 0), ForceHealth::sound);
  EXPECT_EQ(net_ft::health_of(Box::ati, 0x80010000), ForceHealth::sound);
  EXPECT_EQ(net_ft::health_of(Box::ati, 0x80020000), ForceHealth::overload);
  EXPECT_EQ(net_ft::health_of(Box::ati, 0x80004000), ForceHealth::doubted);
  EXPECT_EQ(net_ft::in_words(Box::ati, 0x80024000), "transducer saturation or A/D, watchdog");
  EXPECT_EQ(net_ft::in_words(Box::ati, 0), "");
  EXPECT_EQ(net_ft::in_words(Box::ati, 0x80000000), "unknown");
}

TEST(NetFtProtocol, StatusOfAnEtherDaqNumbersItsSensor) {
  EXPECT_EQ(net_ft::health_of(Box::onrobot, 0x0009), ForceHealth::sound);
  for (std::uint32_t bit = 4; bit <= 9; ++bit)
    EXPECT_EQ(net_ft::health_of(Box::onrobot, 1U << bit), ForceHealth::overload) << bit;
  EXPECT_EQ(net_ft::health_of(Box::onrobot, 0x0400), ForceHealth::doubted);
  EXPECT_EQ(net_ft::in_words(Box::onrobot, 0x0410), "overload, no sensor");
  EXPECT_EQ(net_ft::in_words(Box::onrobot, 0x4800), "sensor failure, communication");
}

std::string page_with(const std::string& force, const std::string& torque, const std::string& counts) {
  return "<netft><prodname>Gamma</prodname><scfgfu> " + force + "\n</scfgfu><scfgtu>" + torque +
         "</scfgtu><cfgcpf>" + counts +
         "</cfgcpf><cfgcpt>2000000</cfgcpt><comrdtrate>7000</comrdtrate><comrdte>Enabled</comrdte></netft>";
}

TEST(NetFtProtocol, APageSaysWhatACountIs) {
  const net_ft::Page page = net_ft::parse_page(page_with("N", "N-m", "1000000"));
  EXPECT_EQ(page.product, "Gamma");
  EXPECT_EQ(page.counts_per_n, 1e6);
  EXPECT_EQ(page.counts_per_n_m, 2e6);
  EXPECT_EQ(page.rate_hz, 7000.0);
  EXPECT_EQ(page.enabled, true);
  EXPECT_FALSE(page.filter);
}

// 1 lbf is 4.4482216152605 N by definition.
TEST(NetFtProtocol, AnyUnitOfAPageBecomesSi) {
  const net_ft::Page pounds = net_ft::parse_page(page_with("lbf", "lbf-in", "1000"));
  EXPECT_DOUBLE_EQ(pounds.counts_per_n, 1000.0 / 4.4482216152605);
  EXPECT_DOUBLE_EQ(pounds.counts_per_n_m, 2e6 / (4.4482216152605 * 0.0254));
  EXPECT_EQ(net_ft::parse_page(page_with("kN", "Nmm", "5")).counts_per_n, 0.005);
  EXPECT_EQ(net_ft::torque_unit_n_m("N-mm"), net_ft::torque_unit_n_m("Nmm"));
  EXPECT_DOUBLE_EQ(*net_ft::torque_unit_n_m("kg-cm"), 0.0980665);
  EXPECT_FALSE(net_ft::force_unit_n("stone"));
}

std::string refusal(const std::string& xml) {
  try {
    (void)net_ft::parse_page(xml);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(NetFtProtocol, APageThatDoesNotSayItIsRefused) {
  EXPECT_THAT(refusal("Not a page"), HasSubstr("no XML"));
  EXPECT_THAT(refusal("<netft/>"), HasSubstr("no <scfgfu>"));
  EXPECT_THAT(refusal(page_with("N", "N-m", "0")), HasSubstr("<cfgcpf> is '0'"));
  EXPECT_THAT(refusal(page_with("N", "N-m", "nan")), HasSubstr("'nan'"));
  EXPECT_THAT(refusal(page_with("N", "N-m", "1e6;1")), HasSubstr("'1e6;1'"));
  EXPECT_THAT(refusal(page_with("stone", "N-m", "1")), HasSubstr("'stone'"));
  EXPECT_THAT(refusal(page_with("N", "stone", "1")), HasSubstr("'stone'"));
}

TEST(ForceMounts, SayComponentSignAndLever) {
  const auto mounts = parse_mounts("theta:-tz/36.9mm,x_s:fx");
  ASSERT_EQ(mounts.size(), 2U);
  EXPECT_EQ(mounts[0].axis, "theta");
  EXPECT_EQ(mounts[0].component, 5U);
  EXPECT_EQ(mounts[0].sign, -1.0);
  EXPECT_DOUBLE_EQ(mounts[0].lever_m, 0.0369);
  EXPECT_EQ(mounts[1].component, 0U);
  EXPECT_EQ(mounts[1].lever_m, 0.0);
  for (const char* wrong : {"theta", "theta:", "theta:fw", ":fx", "theta:fx/0mm", "theta:fx/2"})
    EXPECT_THROW((void)parse_mounts(wrong), DeviceError) << wrong;
}

}  // namespace
}  // namespace kerf::drivers

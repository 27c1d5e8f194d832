#include "session/receipt.h"

#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// A session of three trials whose receipt is kept, and what is done to its file afterwards.
class KeptReceipt : public testing::Test {
 protected:
  KeptReceipt() {
    answer(0);
    early_copy_ = kerf::test::read_text(session_.file());
    answer(1);
    answer(0);
    receipt_ = receipt_of(session_.read());
  }
  void answer(std::size_t slot) {
    SessionStore run = session_.run();
    run.append(kerf::test::answered(run.plan()[run.trials().size() % 3], slot));
    run.close();
  }
  void put_back_the_early_copy() const { kerf::test::write_text(session_.file(), early_copy_); }
  [[nodiscard]] ReceiptFinding finding(const Receipt& receipt) const {
    const SessionStore store = session_.read();
    const auto findings = held_against({receipt}, {{.file = "s2.h5", .session = &store}});
    EXPECT_THAT(findings, SizeIs(1));
    return findings.front();
  }
  void expect_to_find(const std::string& what) const {
    for (const Receipt& receipt : {receipt_, parse_receipt(receipt_.in_short())}) {
      EXPECT_FALSE(finding(receipt).holds);
      EXPECT_THAT(finding(receipt).text, HasSubstr("receipt " + receipt_.in_short() + ": s2.h5 has " + what));
    }
  }

  kerf::test::StoredSession session_;
  std::string early_copy_;
  Receipt receipt_;
};

TEST_F(KeptReceipt, HoldsForTheSessionAndForWhatCameLater) {
  EXPECT_TRUE(finding(receipt_).holds);
  EXPECT_TRUE(finding(parse_receipt(receipt_.in_full())).holds);
  answer(1);
  EXPECT_TRUE(finding(receipt_).holds);
  EXPECT_THAT(finding(receipt_).text, HasSubstr("is as it was, with 1 later entries"));
}

TEST_F(KeptReceipt, FindsEntriesThatWereCutOff) {
  schema::Session cut = schema::read_session(session_.file());
  ASSERT_THAT(cut.entries, SizeIs(4));
  cut.entries.pop_back();
  schema::write_session(session_.file(), cut);
  expect_to_find("3 entries, and had 4: it was cut short");
  cut.entries.resize(1);
  schema::write_session(session_.file(), cut);
  expect_to_find("1 entries, and had 4");
}

TEST_F(KeptReceipt, FindsAnOlderCopy) {
  put_back_the_early_copy();
  expect_to_find("2 entries, and had 4: it was cut short, or an older copy was put back");
}

TEST_F(KeptReceipt, FindsAnOlderCopyThatWasRunOn) {
  put_back_the_early_copy();
  answer(1);
  answer(0);
  expect_to_find("other entries than it had: an older copy was put back and run on");
  answer(0);
  expect_to_find("other entries than it had");
}

TEST_F(KeptReceipt, FindsASessionThatWasReplacedByAnother) {
  const kerf::test::StoredSession another;
  const SessionStore store = another.read();
  const auto findings = held_against({receipt_}, {{.file = "s2.h5", .session = &store}});
  ASSERT_THAT(findings, SizeIs(2));
  EXPECT_FALSE(findings[0].holds);
  EXPECT_THAT(findings[0].text, HasSubstr("none of the files is its session"));
  EXPECT_FALSE(findings[1].holds);
  EXPECT_EQ(findings[1].text, "s2.h5: none of the receipts is of this session");
}

TEST_F(KeptReceipt, StandsInAFileWithThoseBeforeIt) {
  keep_receipt(session_.file(), receipt_);
  answer(1);
  keep_receipt(session_.file(), receipt_of(session_.read()));
  const auto receipts = receipts_named(receipts_of(session_.file()).string());
  ASSERT_THAT(receipts, SizeIs(2));
  EXPECT_EQ(receipts[0].in_full(), receipt_.in_full());
  EXPECT_EQ(receipts[1].entries, 5U);
  const SessionStore store = session_.read();
  for (const auto& one : held_against(receipts, {{.file = "s2.h5", .session = &store}}))
    EXPECT_TRUE(one.holds) << one.text;
}

TEST(ReceiptText, ThatIsNoneIsRefused) {
  EXPECT_EQ(parse_receipt("1f3c9a2e/12/a1b2c3d4e5f60718").entries, 12U);
  for (const char* text :
       {"", "12", "1f3c9a2e/12", "1f3c9a2/12/a1b2c3d4e5f60718", "1f3c9a2e/12/a1b2c3d4e5f6071",
        "1f3c9a2e/0/a1b2c3d4e5f60718", "1f3c9a2e/-1/a1b2c3d4e5f60718", "1f3c9a2e/1x/a1b2c3d4e5f60718",
        "1f3c9a2e//a1b2c3d4e5f60718", "1f3c9a2g/12/a1b2c3d4e5f60718", "1f3c9a2e/12/a1b2c3d4e5f6071x"})
    EXPECT_THROW((void)parse_receipt(text), std::invalid_argument) << text;
  const kerf::test::TemporaryFolder folder;
  kerf::test::write_text(folder / "r", "\nx 1f3c9a2e/12/a1b2c3d4e5f60718\r\nnothing\n");
  EXPECT_THAT([&] { (void)receipts_named((folder / "r").string()); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("r:3: 'nothing' is no receipt")));
  kerf::test::write_text(folder / "empty", "\n");
  EXPECT_THROW((void)receipts_named((folder / "empty").string()), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

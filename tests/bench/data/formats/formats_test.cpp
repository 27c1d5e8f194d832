#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/cell_format.h"
#include "formats/file_text.h"
#include "formats/gzip.h"
#include "formats/mat_table.h"
#include "formats/unpacked_apart.h"
#include "formats/utf16.h"
#include "import/import.h"
#include "support/measured_data.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::filesystem::path made(const std::string& name) {
  return std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/data/formats/files" / name;
}

Imported imported(const std::filesystem::path& file, const std::string& map, const std::string& sheet = "") {
  ImportOptions options{.map = parse_map(map)};
  options.sheet = sheet;
  return import_text(file, options);
}

/// All rows, to the last bit of a double; forces to that of what the file holds.
void expect_the_motion(const schema::Recording& recording, double force_tolerance = 0.0) {
  ASSERT_EQ(recording.rows(), 40U);
  for (std::size_t row = 0; row < 40; ++row) {
    const double time = static_cast<double>(row) / 100.0;
    EXPECT_EQ(recording.time[row], time);
    EXPECT_NEAR(recording.position[row], 0.01 * std::sin(7.0 * time), 4e-18);
    EXPECT_NEAR(recording.force_measured[row], 300.0 * recording.position[row] + 0.1,
                1e-15 + force_tolerance);
  }
}

class BadFile : public testing::Test {
 protected:
  std::string wrote(const std::string& name, const std::string& bytes) {
    test::write_text(folder_ / name, bytes);
    return (folder_ / name).string();
  }
  static void expect_refused(const std::string& file, const std::string& why,
                             std::size_t max_bytes = 1U << 20U) {
    EXPECT_THAT([&] { (void)FileText(file, {.max_bytes = max_bytes}); },
                ThrowsMessage<std::invalid_argument>(testing::AllOf(HasSubstr(file), HasSubstr(why))));
  }
  test::TemporaryFolder folder_;
};

TEST(Gzip, IsUnpackedWhereverItComesFrom) {
  for (const auto* name : {"punch.txt.gz", "members.txt.gz"}) {
    const Imported one = imported(made(name), "time=time,position=position,force=force");
    expect_the_motion(one.recording);
    EXPECT_THAT(one.warnings, Contains("unpacked by gzip")) << name;
    EXPECT_THAT(one.recording.header.source, HasSubstr(std::string(name) + " sha256:"));
  }
}

TEST_F(BadFile, OfGzipIsRefused) {
  const std::string packed = test::read_text(made("punch.txt.gz"));
  expect_refused(wrote("cut.gz", packed.substr(0, packed.size() / 2)), "cut short after");
  expect_refused(wrote("headless.gz", packed.substr(0, 3)), "cut short after 0 bytes");
  std::string damaged = packed;
  damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x20);
  expect_refused(wrote("damaged.gz", damaged), "is damaged after");
  expect_refused(wrote("more.gz", packed + "rest"), "4 bytes after what gzip packed");
  EXPECT_NO_THROW(FileText(wrote("padded.gz", packed + std::string(512, '\0')), {.max_bytes = 1U << 20U}));
  expect_refused(made("punch.txt.gz"), "unpacks to more than 1000 bytes", 1000);
}

TEST(Utf16, IsReadWithItsMarkAndWithout) {
  for (const auto* name : {"punch-utf16.txt", "punch-utf16be.txt"}) {
    expect_the_motion(imported(made(name), "time=time,position=position,force=force").recording);
  }
  EXPECT_EQ(utf16_order("1.25\t3.5\n2.25\t4.5\n"), std::nullopt);
  EXPECT_EQ(utf16_order(std::string(64, '\0')), std::nullopt);
  EXPECT_EQ(utf8_of_utf16(std::string_view("\xFF\xFE"
                                           "a\0"
                                           "\xB5\0"
                                           "\x1C\x20",
                                           8),
                          Utf16::little_endian, "x"),
            "aµ“");
}

TEST_F(BadFile, OfUtf16NamesItsByte) {
  expect_refused(wrote("x.txt", std::string("\xFF\xFE"
                                            "1\0"
                                            "\x00\xD8"
                                            "2\0",
                                            8)),
                 "begins as UTF-16, but byte 4 is none");
}

TEST(Workbook, IsReadAsItWasComputedLast) {
  const Imported one = imported(made("punch.xlsx"), "time=time,position=position,force=force");
  const schema::Recording& recording = one.recording;
  ASSERT_EQ(recording.rows(), 38U) << "two forces are text";
  EXPECT_EQ(one.bad_lines, (std::vector<std::size_t>{20, 21})) << "rows of the sheet";
  EXPECT_EQ(recording.time[0], 0.0);
  EXPECT_EQ(recording.time[37], 0.39);
  EXPECT_EQ(recording.force_measured[0], 0.1) << "typed with a decimal comma";
  EXPECT_DOUBLE_EQ(recording.force_measured[15], 300.0 * recording.position[15] + 0.1);
  EXPECT_EQ(one.layout.units_line, 3U);
  EXPECT_THAT(one.warnings,
              Contains(HasSubstr("sheet 'Run 1' is taken, the first with numbers; --sheet takes "
                                 "another: 'Notes', 'Old' (hidden), 'Run 2'")));
  EXPECT_THAT(one.warnings, Contains(HasSubstr("9 numbers were written as text, with a decimal comma, '")));
  EXPECT_THAT(one.warnings, Contains(HasSubstr("40 formulas have no value in the file")));
  EXPECT_THAT(one.warnings,
              Contains(HasSubstr("merged cells hold their value in the first of them alone: A1:C1")));
  EXPECT_THAT(
      one.warnings,
      Contains(HasSubstr("40 cells are dates or times: they are taken in seconds, since 1899-12-30")));
}

TEST(Workbook, TakesADateForSeconds) {
  const Imported one = imported(made("punch.xlsx"), "time=at[s],position=position,force=force");
  ASSERT_EQ(one.recording.rows(), 38U);
  for (const double time : one.recording.time)
    EXPECT_NEAR(100.0 * time, std::round(100.0 * time), 2e-3) << "a day's fraction in fifteen digits";
  EXPECT_NEAR(one.recording.time.back(), 0.39, 1e-5);
}

TEST(Workbook, TakesTheSheetThatIsAskedFor) {
  for (const auto* sheet : {"Run 2", "4"}) {
    const Imported one = imported(made("punch.xlsx"), "time=1[s],position=2[m],force=3[N]", sheet);
    EXPECT_EQ(one.recording.rows(), 10U);
    EXPECT_EQ(one.recording.position[9], 0.001 * 0.09);
  }
  EXPECT_EQ(imported(made("punch.xlsx"), "time=1[s],position=2[m],force=3[N]", "Run 2").warnings.size(), 0U);
  const test::TemporaryFolder folder;
  const auto refused = test::run_kerf({"import", made("punch.xlsx").string(), "--sheet", "Run 3", "--map",
                                       "time=1", "-o", (folder / "none.h5").string()});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(
      refused.errors,
      HasSubstr("--sheet: there is no sheet 'Run 3'; there are 'Notes', 'Old' (hidden), 'Run 1', 'Run 2'"));
}

TEST(OldWorkbook, IsTheNewOneToTheBit) {
  const std::string map = "time=time,position=position,force=force,sum=sum[1]";
  const Imported old = imported(made("punch.xls"), map);
  const Imported young = imported(made("punch.xlsx"), "time=time,position=position,force=force");
  ASSERT_EQ(old.recording.rows(), 38U) << "two forces are text";
  EXPECT_EQ(old.bad_lines, (std::vector<std::size_t>{20, 21})) << "rows of the sheet";
  EXPECT_EQ(old.recording.position[10], young.recording.position[10]);
  EXPECT_EQ(old.recording.force_measured[0], 0.1) << "typed with a decimal comma";
  EXPECT_EQ(old.recording.force_measured[15], young.recording.force_measured[15]);
  EXPECT_EQ(old.recording.channels[0].values[10], old.recording.time[10] + old.recording.position[10])
      << "LibreOffice has computed the formulas";
  EXPECT_THAT(old.warnings,
              Contains(HasSubstr("sheet 'Run 1' is taken, the first with numbers; --sheet takes "
                                 "another: 'Notes', 'Old' (hidden), 'Run 2'")));
  EXPECT_THAT(
      old.warnings,
      Contains("sheet 'Run 1': 9 numbers were written as text, with a decimal comma, '0,1' in row 4 is the "
               "first"));
  EXPECT_THAT(old.warnings,
              Contains("sheet 'Run 1': merged cells hold their value in the first of them alone: A1:C1"));
  EXPECT_THAT(old.warnings, Contains("sheet 'Run 1': 1 formulas give a text or an error, and are empty"));
  EXPECT_THAT(old.warnings, Contains(HasSubstr("40 cells are dates or times")));
}

TEST(OldWorkbook, TakesADateForSecondsToItsLastDigit) {
  const Imported one = imported(made("punch.xls"), "time=at[s],position=position,force=force");
  ASSERT_EQ(one.recording.rows(), 38U);
  EXPECT_NEAR(one.recording.time[1], 0.01, 2e-5) << "freexl gives whole seconds";
  EXPECT_NEAR(one.recording.time.back(), 0.39, 2e-5);
}

TEST(OldWorkbook, TakesTheSheetThatIsAskedFor) {
  for (const auto* sheet : {"Run 2", "4"}) {
    const Imported one = imported(made("punch.xls"), "time=1[s],position=2[m],force=3[N]", sheet);
    EXPECT_EQ(one.recording.rows(), 10U);
    EXPECT_EQ(one.recording.position[9], 0.001 * 0.09);
  }
  EXPECT_THAT([] { (void)imported(made("punch.xls"), "time=1[s],position=2[m]", "Run 3"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(
                  "there is no sheet 'Run 3'; there are 'Notes', 'Old' (hidden), 'Run 1', 'Run 2'")));
}

TEST_F(BadFile, OfAnOldWorkbookIsRefused) {
  const std::string book = test::read_text(made("punch.xls"));
  expect_refused(wrote("cut.xls", book.substr(0, book.size() / 2)), "is it whole?");
  expect_refused(wrote("magic.xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"), "is it whole?");
  // The record that begins an encrypted book, in place of one that says who wrote it.
  std::string secret = book;
  const std::string author("\x5C\x00\x70\x00", 4);
  ASSERT_NE(secret.find(author), std::string::npos);
  secret[secret.find(author)] = '\x2F';
  expect_refused(wrote("secret.xls", secret), "protected by a password");
  std::string letter = book;
  const std::string name("W\0o\0r\0k\0", 8);
  letter.replace(letter.find(name), name.size(), std::string("L\0e\0t\0t\0", 8));
  expect_refused(wrote("letter.doc", letter), "an old Office file, but no workbook");
}

TEST_F(BadFile, OfAZipIsRefused) {
  const std::string book = test::read_text(made("punch.xlsx"));
  expect_refused(wrote("cut.xlsx", book.substr(0, book.size() / 2)), "a zip that cannot be opened");
  expect_refused(made("punch.xlsx"), "unpacks to more than 9000 bytes", 9000);
}

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>((value >> (8 * i)) & 0xFFU);
  return text;
}

std::uint32_t crc32_of(const std::string& text) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// A zip of files that are stored as they are (APPNOTE 6.3), so that what is in them can be anything.
std::string zipped(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string zip;
  std::string directory;
  for (const auto& [name, content] : files) {
    const std::string about = little(20, 2) + little(0, 2) + little(0, 2) + little(0, 4) +
                              little(crc32_of(content), 4) + little(content.size(), 4) +
                              little(content.size(), 4) + little(name.size(), 2) + little(0, 2);
    directory += "PK\x01\x02" + little(20, 2) + about + little(0, 2) + little(0, 2) + little(0, 2) +
                 little(0, 4) + little(zip.size(), 4) + name;
    zip += "PK\x03\x04" + about + name + content;
  }
  return zip + directory + "PK\x05\x06" + little(0, 4) + little(files.size(), 2) + little(files.size(), 2) +
         little(directory.size(), 4) + little(zip.size(), 4) + little(0, 2);
}

/// A workbook of one sheet with these rows, in XML.
std::string book_of(const std::string& rows) {
  const std::string relation =
      R"(<Relationships><Relationship Id="a" Type="x/officeDocument" Target="b.xml"/></Relationships>)";
  const std::string sheets =
      R"(<Relationships><Relationship Id="s" Type="x/worksheet" Target="s.xml"/></Relationships>)";
  return zipped({{"_rels/.rels", relation},
                 {"b.xml", R"(<workbook><sheets><sheet name="A" r:id="s"/></sheets></workbook>)"},
                 {"_rels/b.xml.rels", sheets},
                 {"s.xml", "<worksheet><sheetData>" + rows + "</sheetData></worksheet>"}});
}

TEST_F(BadFile, ThatIsAWorkbookByHandIsReadOrRefused) {
  const std::string good =
      wrote("good.xlsx",
            book_of(R"(<row><c><v>1</v></c><c r="C1"><v>2</v></c></row><row r="3"><c><v>3</v></c></row>)"));
  EXPECT_EQ(FileText(good, {.max_bytes = 1U << 20U}).text(), "1\t\t2\n\n3\t\t\n")
      << "cells and rows without a reference follow";
  expect_refused(wrote("half.xlsx", book_of(R"(<row r="0.5"><c><v>1</v></c></row>)")),
                 "row '0.5' after row 0");
  expect_refused(wrote("back.xlsx", book_of(R"(<row r="4"/><row r="4"/>)")), "row '4' after row 4");
  expect_refused(wrote("far.xlsx", book_of(R"(<row r="99999999999999999999"/>)")), "after row 0");
  expect_refused(wrote("nan.xlsx", book_of(R"(<row><c t="s"><v>nan</v></c></row>)")), "there is no text nan");
  expect_refused(wrote("text.xlsx", book_of(R"(<row><c t="s"><v>-1</v></c></row>)")), "there is no text -1");
  expect_refused(wrote("cell.xlsx", book_of(R"(<row><c r="ZZZZ1"><v>1</v></c></row>)")),
                 "'ZZZZ1' is no cell");
  EXPECT_NO_THROW(
      FileText(wrote("style.xlsx", book_of(R"(<row><c s="-5"><v>1</v></c><c s="1e300"><v>2</v></c></row>)")),
               {.max_bytes = 1U << 20U}));
  std::string wide;
  for (int row = 0; row < 2000; ++row) wide += R"(<row><c r="XFD1"><v>1</v></c></row>)";
  expect_refused(wrote("wide.xlsx", book_of(wide)), "a sheet of more than 1048576 bytes");
}

TEST_F(BadFile, ThatIsChangedAnywhereIsReadOrRefusedInOneLine) {
  for (const auto* name :
       {"punch.xlsx", "punch.xls", "punch.mat", "plain.mat", "punch73.mat", "punch.txt.gz"}) {
    const std::string whole = test::read_text(made(name));
    const std::size_t places =
        std::string(name) == "punch73.mat" || std::string(name) == "punch.xls" ? 50 : 200;
    for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / places) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 8)));
      const std::string file = wrote("changed", i % 3 == 0 ? whole.substr(0, i) : changed);
      try {
        (void)FileText(file, {.max_bytes = 1U << 20U});
      } catch (const std::invalid_argument& refused) {
        EXPECT_EQ(std::string(refused.what()).find('\n'), std::string::npos) << name << " " << i;
      }
    }
  }
}

TEST(CellFormat, TellsDatesAndDurations) {
  for (const auto* code :
       {"yyyy-mm-dd", "[h]:mm:ss", "d/m/yy", "\"at\" hh:mm", "[$-409]m/d/yy h:mm AM/PM", "mm:ss.0"})
    EXPECT_TRUE(is_date_format(164, code)) << code;
  for (const auto* code : {"General", "0.00", "#,##0 \"days\"", "[Red]0.0", "0.00E+00", "0\\d", "@", "0 \"h"})
    EXPECT_FALSE(is_date_format(164, code)) << code;
  EXPECT_TRUE(is_date_format(14, ""));
  EXPECT_FALSE(is_date_format(2, ""));
}

TEST(MatFile, HasItsVectorsAsColumns) {
  const Imported one =
      imported(made("punch.mat"), "time=t[s],position=run.x[m],force=run.f[N],count=counts[2][1]");
  expect_the_motion(one.recording, 2e-7);  // float32
  ASSERT_EQ(one.recording.channels.size(), 1U);
  EXPECT_EQ(one.recording.channels[0].values[5], 11.0) << "the second column of int16";
  EXPECT_THAT(one.warnings, Contains(HasSubstr("short has 7 elements and is left out")));
  EXPECT_THAT(one.warnings, Contains(HasSubstr("run.who is no vector or matrix of real numbers")));
  expect_the_motion(imported(made("plain.mat"), "time=t[s],position=x[m],force=f[N]").recording);
}

TEST(MatFile, OfVersion73LeavesNoCopy) {
  std::string path;
  {
    const MatName copy(test::read_text(made("punch73.mat")));
    path = copy.name();
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(MatFile, OfVersion73IsReadAlike) {
  const std::string map =
      "time=t[s],position=run.x[m],force=run.f[N],count=counts[2][1],ticks=ticks[1],touch=touches[1]";
  const Imported one = imported(made("punch73.mat"), map);
  expect_the_motion(one.recording, 2e-7);  // float32
  ASSERT_EQ(one.recording.channels.size(), 3U);
  EXPECT_EQ(one.recording.channels[0].values[5], 11.0);
  EXPECT_EQ(one.recording.channels[1].values[39], 9007199254740992.0)
      << "2^53, the last one that all doubles reach";
  EXPECT_EQ(one.recording.channels[2].values[0], 0.0) << "a logical";
  EXPECT_EQ(one.recording.channels[2].values[10], 1.0);
  EXPECT_THAT(one.warnings,
              Contains(HasSubstr("stamps has whole numbers beyond 2^53, which would lose their last "
                                 "digits, and is left out: save double(stamps - stamps(1))")));
  EXPECT_THAT(one.warnings,
              Contains(HasSubstr("objects is an object (a table, timetable, string or datetime)")));
  EXPECT_THAT(one.warnings, Contains(HasSubstr("run.who is no vector or matrix of real numbers")));
}

TEST(UnpackedApart, BringsBackWhatIsSaidAndOutlivesAFall) {
  const UnpackedLimits limits{.name = "x.xls", .at_most = 1U << 20U};
  const Unpacked told{.sheet = "Run 1", .notes = {"one", "two"}, .text = "a\tb\n1\t2\n"};
  const Unpacked again = unpacked_from(answer_of(told));
  EXPECT_EQ(again.sheet, told.sheet);
  EXPECT_EQ(again.notes, told.notes);
  EXPECT_EQ(again.text, told.text);
  EXPECT_THAT([] { (void)unpacked_from(refusal_of("no")); }, ThrowsMessage<std::invalid_argument>("no"));
  EXPECT_THAT([&] { (void)unpacked_apart("PK no workbook", "", limits); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("x.xls")));
}

TEST_F(BadFile, OfMatlabThatIsCutIsRefused) {
  std::string head =
      "MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Sat Jan 31 12:00:00 2026 HDF5 schema 1.00 .";
  head.resize(124, ' ');
  expect_refused(wrote("new.mat", head + std::string("\0\x02IM", 4) + std::string(512, '\0')),
                 "no two numeric vectors of one length");
  const std::string plain = test::read_text(made("plain.mat"));
  expect_refused(wrote("cut.mat", plain.substr(0, 200)), "");
}

TEST_F(BadFile, OfAnotherKindIsNamed) {
  expect_refused(wrote("a.txt", "\x89PNG\r\n\x1A\n"), "a picture, not a file of numbers");
  expect_refused(wrote("c.tdms", "TDSm...."), "a TDMS file");
}

constexpr auto lvm_head =
    "LabVIEW "
    "Measurement\t\r\nWriter_Version\t2\r\nSeparator\tTab\r\nDecimal_Separator\t.\r\nX_Columns\tCOLUMNS\r\n"
    "***End_of_Header***\t\r\n\t\r\nChannels\t2\t\t\r\nSamples\t3\t3\t\r\nDate\t2026/01/31\t2026/01/31\t\r\n"
    "Time\t12:00:00.25\t12:00:00.25\t\r\nY_Unit_Label\tmm\tN\t\r\nX_Dimension\tTime\tTime\t\r\n"
    "X0\t0.5\t0.5\t\r\nDelta_X\t0.001000\tSTEP\t\r\n***End_of_Header***\t\t\t\r\n";

std::string lvm(const std::string& columns, const std::string& step, const std::string& rows) {
  std::string text = lvm_head;
  text.replace(text.find("COLUMNS"), 7, columns);
  text.replace(text.find("STEP"), 4, step);
  return text + "X_Value\tWay\tLoad\tComment\r\n" + rows;
}

TEST_F(BadFile, OfLabViewIsReadWithItsUnits) {
  const std::string rows = "0.5\t1\t2\r\n0.501\t1.5\t3\r\n0.502\t2\t4\tslipped\r\n";
  const std::string one = wrote("a.lvm", lvm("One", "0.001", rows));
  const Imported read = imported(one, "time=X_Value,position=Way,force=Load");
  EXPECT_THAT(read.recording.time,
              testing::ElementsAre(0.0, testing::DoubleNear(1e-3, 1e-15), testing::DoubleNear(2e-3, 1e-15)));
  EXPECT_THAT(read.recording.position, testing::ElementsAre(1e-3, 1.5e-3, 2e-3));
  EXPECT_EQ(read.layout.header_line, 17U) << "lines are those of the file";
  EXPECT_TRUE(read.bad_lines.empty());
  EXPECT_THAT(read.warnings, Contains("a LabVIEW measurement file, begun 2026/01/31 12:00:00.25"));
  // date -u -d 2026-01-31T12:00:00Z +%s; its first time is X0 = 0.5 s after that quarter of a second.
  EXPECT_EQ(read.recording.header.start_ns, 1769860800'750'000'000);
  EXPECT_EQ(read.recording.header.start_clock, "local") << "the file names no zone";
  std::string fine = lvm("One", "0.001", rows);
  for (std::size_t at = fine.find(".25\t"); at != std::string::npos; at = fine.find(".25\t", at))
    fine.replace(at, 3, ".1234567894999999999");  // more digits than nanoseconds
  const Imported finer = imported(wrote("f.lvm", fine), "time=X_Value,position=Way,force=Load");
  EXPECT_EQ(finer.recording.header.start_ns, 1769860800'623'456'789);
  const std::string none = wrote("b.lvm", lvm("No", "0.001", "\t1\t2\r\n\t1.5\t3\r\n\t2\t4\r\n"));
  const Imported timed = imported(none, "time=X_Value,position=Way,force=Load");
  EXPECT_NEAR(timed.recording.time[2], 2e-3, 1e-15);
  EXPECT_THAT(timed.recording.force_measured, testing::ElementsAre(2.0, 3.0, 4.0));
  expect_refused(wrote("c.lvm", lvm("No", "0.002", "\t1\t2\r\n")), "channels have different ones");
  expect_refused(wrote("d.lvm", "LabVIEW Measurement\t\r\nX_Columns\tOne\r\n"),
                 "header has no ***End_of_Header***");
}

TEST_F(BadFile, OfLabViewInSegmentsIsOneAfterTheOther) {
  const std::string segment = lvm("One", "0.001", "0.5\t1\t2\n0.501\t1.5\t3\n");
  const std::string next = segment.substr(segment.find("Channels"));
  const Imported read =
      imported(wrote("a.lvm", segment + "\n" + next.substr(0, next.find("0.5\t1\t2")) + "0.502\t2\t4\n"),
               "time=X_Value,position=Way,force=Load");
  EXPECT_THAT(read.recording.force_measured, testing::ElementsAre(2.0, 3.0, 4.0));
  EXPECT_TRUE(read.bad_lines.empty());
  EXPECT_THAT(read.warnings, Contains("its 2 segments follow each other"));
}

TEST_F(BadFile, OfAtiIsReadByItsCounts) {
  std::string text =
      "Start Time: 1/31/2026 12:00:00 PM\nRDT Sample Rate: 1000\nForce Units: N\nCounts per Unit Force: "
      "1000000\n"
      "Torque Units: N-m\nCounts per Unit Torque: 1000000\n"
      "Status (hex), RDT Sequence, F/T Sequence, Fx, Fy, Fz, Tx, Ty, Tz, Time\n";
  for (const auto* row : {"1,1001,1500000", "2,1002,-250000", "5,1005,3"})
    text += std::string("0x0,") + row + ",0,0,0,0,0,12:00:00.001\n";
  const Imported read =
      imported(wrote("ft.csv", text), "time=\"RDT Sequence\"[0.001 s],position=Fy[m],force=Fx[1e-6 N]");
  EXPECT_THAT(read.recording.force_measured, testing::ElementsAre(1.5, -0.25, testing::DoubleEq(3e-6)));
  EXPECT_THAT(read.recording.time, testing::ElementsAre(0.0, 1e-3, 4e-3)) << "lost packets are a gap";
}

TEST(Standard, InputTakesEveryFormat) {
  const test::TemporaryFolder folder;
  for (const auto* name : {"punch.txt.gz", "punch-utf16.txt", "plain.mat", "punch.xlsx", "punch.xls"}) {
    const bool is_mat = std::string(name) == "plain.mat";
    const auto outcome = test::run(
        {"sh", "-c",
         "cat " + made(name).string() + " | " + KERF_PROGRAM + " import - --map '" +
             (is_mat ? "time=t[s],position=x[m],force=f[N]" : "time=time,position=position,force=force") +
             "' --force -o " + (folder / "r.h5").string()});
    ASSERT_EQ(outcome.exit_status, 0) << name << outcome.errors;
    EXPECT_GE(schema::read_recording(folder / "r.h5").rows(), 38U) << name;
  }
}

TEST(Workbook, OfARelaxationIsTheOneOfItsText) {
  const std::string file = "vhb/relaxation_4d0.xlsx";
  KERF_NEEDS_DATA(file);
  const Imported one = imported(test::measured_file(file),
                                "time=Time_s[s],position=CalculatedValue[mm],force=AdjustedForce[mN]");
  ASSERT_EQ(one.recording.rows(), 801U);
  EXPECT_EQ(one.recording.time[2], 1.0);
  EXPECT_EQ(one.recording.force_measured[1], 33.21911229946524e-3) << "as openpyxl reads it";
}

}  // namespace
}  // namespace kerf::bench

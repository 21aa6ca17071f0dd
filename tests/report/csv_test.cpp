#include "evo/report/csv.hpp"

#include "evo/core/error.hpp"
#include "report/fixtures.hpp"

namespace evo::report {
namespace {

class CsvTest : public ReportTest {
 protected:
  CsvTable Read(const std::string& text) {
    std::ofstream(folder / "table.csv", std::ios::binary) << text;
    return ReadCsv(folder / "table.csv");
  }

  /// The message, which must name the file.
  std::string Refusal(const std::string& text) {
    try {
      Read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_NE(std::string(error.what()).find("table.csv:"), std::string::npos) << error.what();
      return std::string(error.what()).substr((folder / "table.csv").string().size());
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
  }
};

using Row = std::vector<std::string>;

TEST_F(CsvTest, ReadsQuotedCells) {
  const auto table = Read("a,b,c\n1,\"x, \"\"y\"\"\",\n\"two\nlines\",\"\",3\r\n");
  EXPECT_EQ(table.columns, (Row{"a", "b", "c"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0], (Row{"1", "x, \"y\"", ""}));
  EXPECT_EQ(table.rows[1], (Row{"two\nlines", "", "3"}));
  EXPECT_EQ(table.lines, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(table.Find("c"), 2u);
  EXPECT_EQ(table.Find("d"), std::nullopt);
}

TEST_F(CsvTest, ReadsBackWhatItWrote) {
  CsvTable table;
  table.columns = {"name", "text, quoted"};
  table.rows = {{"plain", "a\r\nb"}, {"", "\"\""}, {" blanks ", "\xc3\xa9,"}};
  WriteCsv(folder / "table.csv", table);
  const auto copy = ReadCsv(folder / "table.csv");
  EXPECT_EQ(copy.columns, table.columns);
  EXPECT_EQ(copy.rows, table.rows);
}

TEST_F(CsvTest, ErrorsNameTheLine) {
  EXPECT_TRUE(Refusal("").starts_with(":1: ")) << "empty";
  EXPECT_TRUE(Refusal("a,a\n").starts_with(":1: ")) << "twice the same column";
  EXPECT_TRUE(Refusal("a,,b\n").starts_with(":1: ")) << "a column without a name";
  EXPECT_TRUE(Refusal("a,b\n1,2\n3\n").starts_with(":3: ")) << "a cell is missing";
  EXPECT_TRUE(Refusal("a,b\n\"x\ny\",2\n1,2,3\n").starts_with(":4: ")) << "one too many";
  EXPECT_TRUE(Refusal("a,b\n1,2\n3,4").starts_with(":3: ")) << "cut short";
  EXPECT_TRUE(Refusal("a,b\n1,\"2\n").starts_with(":2: ")) << "open quote";
  EXPECT_TRUE(Refusal("a,b\n1,\"2\"x\n").starts_with(":2: ")) << "text after a closing quote";
  EXPECT_TRUE(Refusal("a,b\n1,x\"2\n").starts_with(":2: ")) << "quote inside a cell";
  EXPECT_TRUE(Refusal(std::string("a,b\n1,\0\n", 8)).starts_with(":2: ")) << "not text";
}

TEST_F(CsvTest, MissingFilesAreInputErrors) {
  EXPECT_THROW(ReadCsv(folder / "absent.csv"), Error);
  EXPECT_THROW(ReadCsv(folder), Error);
}

}  // namespace
}  // namespace evo::report

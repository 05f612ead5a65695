#include "statistics/golden_test.hpp"

#include <checkout.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/csv.hpp"

namespace tractus {
namespace statistics::golden {
namespace {

const std::string kRoot = std::string(checkout::kSource) + "/tests/golden/statistics-reference/";

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(kRoot + path);
  EXPECT_TRUE(file) << path;
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) out.push_back(line);
  return out;
}

std::vector<double> numbers_in(const std::string& line) {
  std::vector<double> out;
  std::stringstream stream(line);
  for (std::string word; stream >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() && *end == '\0') out.push_back(value);
  }
  return out;
}

}  // namespace

core::Json expected(const std::string& name) {
  auto json = core::read_json(kRoot + "expected/" + name + ".json");
  EXPECT_TRUE(json) << name;
  return *json;
}

Vector vector_of(const core::Json& numbers) {
  if (!numbers.is_array()) return Vector::Constant(1, numbers.get<double>());
  Vector out(static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = numbers[i].get<double>();
  return out;
}

core::Json as_list(const core::Json& numbers) {
  return numbers.is_array() ? numbers : core::Json::array({numbers});
}

Matrix matrix_of(const core::Json& rows) {
  Matrix out(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) = vector_of(rows[i]).transpose();
  return out;
}

Csv::Csv(const std::string& path) {
  auto reader = core::CsvReader::open(kRoot + path, 1 << 20);
  EXPECT_TRUE(reader) << path;
  std::vector<std::string_view> cells;
  while (*reader->next(cells))
    if (!core::is_blank(cells)) rows_.emplace_back(cells.begin(), cells.end());
  header_ = rows_.at(0);
  rows_.erase(rows_.begin());
}

std::vector<std::string> Csv::texts(const std::string& column) const {
  const auto at = std::ranges::find(header_, column);
  EXPECT_NE(at, header_.end()) << column;
  std::vector<std::string> out;
  for (const auto& row : rows_)
    out.push_back(row.at(static_cast<std::size_t>(at - header_.begin())));
  return out;
}

Vector Csv::numbers(const std::string& column) const {
  const auto text = texts(column);
  Vector out(static_cast<Eigen::Index>(text.size()));
  for (std::size_t i = 0; i < text.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = std::strtod(text[i].c_str(), nullptr);
  return out;
}

Matrix Csv::numeric_from(std::size_t first_column) const {
  const std::size_t width = header_.size() - first_column;
  Matrix out(static_cast<Eigen::Index>(rows_.size()), static_cast<Eigen::Index>(width));
  for (std::size_t j = 0; j < width; ++j)
    out.col(static_cast<Eigen::Index>(j)) = numbers(header_[first_column + j]);
  return out;
}

void expect_near(double got, const core::Json& want, double relative, const std::string& what) {
  if (want.is_null()) {
    EXPECT_FALSE(std::isfinite(got)) << what;
    return;
  }
  const double value = want.get<double>();
  EXPECT_NEAR(got, value, relative * (value == 0.0 ? 1.0 : std::abs(value))) << what;
}

void expect_near(const Vector& got, const core::Json& want, double relative,
                 const std::string& what) {
  if (!want.is_array()) {
    ASSERT_EQ(got.size(), 1) << what;
    return expect_near(got[0], want, relative, what);
  }
  ASSERT_EQ(static_cast<std::size_t>(got.size()), want.size()) << what;
  for (std::size_t i = 0; i < want.size(); ++i)
    expect_near(got[static_cast<Eigen::Index>(i)], want[i], relative,
                what + "[" + std::to_string(i) + "]");
}

std::vector<std::vector<double>> nist_rows(const std::string& path, std::size_t first,
                                           std::size_t last) {
  const auto lines = lines_of(path);
  std::vector<std::vector<double>> out;
  for (std::size_t i = first; i <= std::min(last, lines.size()); ++i)
    if (auto row = numbers_in(lines[i - 1]); !row.empty()) out.push_back(std::move(row));
  return out;
}

std::vector<double> nist_line(const std::string& path, const std::string& label) {
  for (const auto& line : lines_of(path))
    if (const auto at = line.find(label); at != std::string::npos)
      if (auto row = numbers_in(line.substr(at + label.size())); !row.empty()) return row;
  ADD_FAILURE() << path << " has no line with " << label;
  return {};
}

double digits(double got, double want) {
  if (got == want) return 15.0;
  const double error = want == 0.0 ? std::abs(got) : std::abs(got - want) / std::abs(want);
  return std::min(15.0, -std::log10(error));
}

}  // namespace statistics::golden
}  // namespace tractus

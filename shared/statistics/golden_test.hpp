/// Reads the reference values that the tests of this folder are held against.
#pragma once

#include <gtest/gtest.h>

#include "core/json.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::statistics::golden {

/// tests/golden/statistics-reference/expected/NAME.json
core::Json expected(const std::string& name);
Vector vector_of(const core::Json& numbers);
Matrix matrix_of(const core::Json& rows);
/// R writes a vector of one number as a number: a list in either case.
core::Json as_list(const core::Json& numbers);

/// A CSV of the reference: texts by column name.
class Csv {
 public:
  explicit Csv(const std::string& path);  ///< within tests/golden/statistics-reference
  Vector numbers(const std::string& column) const;
  std::vector<std::string> texts(const std::string& column) const;
  Matrix numeric_from(std::size_t first_column) const;  ///< every column from this one on

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// |got − want| ≤ relative · |want| (absolute where want is 0). `null` asks for a number that is
/// not finite.
void expect_near(double got, const core::Json& want, double relative, const std::string& what);
void expect_near(const Vector& got, const core::Json& want, double relative,
                 const std::string& what);

/// A certified NIST file: its text, and the numbers of its lines first…last (1-based).
std::vector<std::vector<double>> nist_rows(const std::string& path, std::size_t first,
                                           std::size_t last);
/// The numbers of the first line that contains `label`, those after the label.
std::vector<double> nist_line(const std::string& path, const std::string& label);
/// Correct digits: −log10(|got − want| / |want|), of |got| alone where want is 0; at most 15.
double digits(double got, double want);

}  // namespace tractus::statistics::golden

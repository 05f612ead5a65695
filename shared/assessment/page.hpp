/// Pages without a server: one HTML file that holds its style and its pictures, and prints.
#pragma once

#include <string>
#include <string_view>

#include "core/json.hpp"
#include "plot/figure.hpp"

namespace tractus::assessment {

/// Builds a page from top to bottom. Every text is escaped.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  /// A paragraph in a frame: what must not be overlooked.
  void warning(std::string_view text);
  void list(const core::Json& sentences);
  /// An array of objects as rows; an object as name and value. Nothing for empty ones.
  void table(const core::Json& values);
  void figure(const plot::Figure& figure);
  void small(std::string_view text);

  std::string html() const;

 private:
  std::string title_, body_;
};

/// A number as people read it: five significant digits; "–" for none.
std::string readable(const core::Json& value);

}  // namespace tractus::assessment

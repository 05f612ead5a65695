/// JSON read with messages that name the file and the field.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/named.hpp"
#include "core/result.hpp"

namespace tractus::core {

using Json = nlohmann::ordered_json;

/// What is read of one document.
struct JsonLimits {
  std::size_t depth;             ///< deeper, and whatever copies it overflows the stack
  std::size_t values;            ///< objects, arrays, texts and numbers together
  std::size_t members = 20'000;  ///< of one object
  std::size_t number_characters = 64;
};
/// From outside.
inline constexpr JsonLimits kForeignJson{.depth = 32, .values = 2'000'000};
/// Stored by this program: documents from outside within one of its own, as a trial's events.
inline constexpr JsonLimits kStoredJson{.depth = 64, .values = 6'000'000};

/// Parses; the only JSON parser of the program. `name` (a file or a sender) leads the message.
/// Errors: bad_input for a text that is not JSON in UTF-8 (with line and column), that goes over
/// one of the limits, that names a member of an object twice, or holds a number beyond a double.
Result<Json> parse_json(std::string_view text, std::string_view name,
                        const JsonLimits& limits = kForeignJson);
/// A text that this program stored itself, parsed within kStoredJson; null when it is damaged.
Json stored_json(std::string_view text);
/// Reads and parses a file of at most 64 MiB.
Result<Json> read_json(const std::filesystem::path& path);
/// Writes with two-space indent and a final newline, atomically.
Result<void> write_json(const std::filesystem::path& path, const Json& json);

/// Reads fields of one JSON object, remembering the first thing wrong. Fields left unread are
/// errors at `done`, so that a misspelt name never passes silently.
class Fields {
 public:
  /// @param where  file and JSON pointer of the object, as "case.json: /probe".
  Fields(const Json& object, std::string where);

  double number(const char* key, double low, double high);
  double number_or(const char* key, double fallback, double low, double high);
  long integer(const char* key, long low, long high);
  long integer_or(const char* key, long fallback, long low, long high);
  std::string text(const char* key, std::size_t limit = 4096);
  std::string text_or(const char* key, std::string fallback, std::size_t limit = 4096);
  /// A word of an enum.
  template <Named E>
  E word(const char* key) {
    return word_of<E>(key, text(key, kLongestWord));
  }
  template <Named E>
  E word_or(const char* key, E fallback) {
    return word_of<E>(key, text_or(key, std::string(name(fallback)), kLongestWord));
  }
  /// Exactly `size` finite numbers.
  std::vector<double> numbers(const char* key, std::size_t size);
  /// The raw member, or null (with the error noted when `needed`).
  const Json* member(const char* key, bool needed = true);
  bool has(const char* key) const;
  /// Marks a field as known and ignored.
  void skip(const char* key);
  /// Notes an error of the caller's own on a field.
  void wrong(const char* key, std::string why);
  /// The first error, or an unknown field, or nothing.
  Result<void> done() const;
  const std::string& where() const { return where_; }

 private:
  static constexpr std::size_t kLongestWord = 64;
  template <Named E>
  E word_of(const char* key, const std::string& given) {
    const auto known = from_name<E>(given);
    if (!known) unknown_word(key, given, names_listed<E>());
    return known.value_or(E{});
  }
  void unknown_word(const char* key, const std::string& given, const std::string& allowed);
  const Json* find(const char* key);
  const Json& object_;
  std::string where_;
  std::string first_error_;
  std::vector<std::string> seen_;
};

/// Null for no value and for an empty text.
template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
inline Json or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

/// A member that is a text; empty if there is none of that name, or it is none.
inline std::string text_member(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace tractus::core

/// The catalogues of e-mails: whole, and filled in as the English sentences are.
#include "server/api/operations/messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/json.hpp"
#include "server/api/operations/notification_text.hpp"

namespace tractus {
namespace api {
namespace {

std::set<std::string> placeholders(std::string_view text) {
  std::set<std::string> out;
  for (auto at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1))
    out.emplace(text.substr(at, text.find('}', at) - at));
  return out;
}

bool is_line(std::string_view text) {
  return !text.empty() && text.front() != ' ' && text.back() != ' ' &&
         std::ranges::none_of(text, [](char c) { return c >= 0 && c < 32; });
}

TEST(Messages, EveryLanguageHasASoundTranslationOfEachSentenceAndNoOther) {
  const auto sentences = mail_sentences();
  ASSERT_EQ(sentences.size(), 17u) << "two of each of seven kinds, and three of all";
  ASSERT_EQ(message_files().size(), 2u) << "German and French";
  for (const MessageFile& file : message_files()) {
    const auto json = core::parse_json(file.json, std::string(file.language));
    ASSERT_TRUE(json && json->is_object()) << file.language;
    for (const std::string& english : sentences) {
      SCOPED_TRACE(std::string(file.language) + ": " + english);
      const std::string text = core::text_member(*json, english.c_str());
      EXPECT_TRUE(is_line(text)) << "missing, or not a line: " << text;
      EXPECT_EQ(placeholders(text), placeholders(english)) << text;
      EXPECT_EQ(translated(english, file.language), text);
    }
    for (const auto& [english, text] : json->items())
      EXPECT_EQ(std::ranges::count(sentences, english), 1) << "said nowhere: " << english;
  }
}

TEST(Messages, AreInEnglishWhereTheLanguageOrTheSentenceIsUnknown) {
  const std::string known = "A backup failed.";
  for (const char* language : {"", "en", "rm", "de-CH", "../de"})
    EXPECT_EQ(translated(known, language), known) << language;
  EXPECT_EQ(translated("No page says this.", "de"), "No page says this.");
  EXPECT_EQ(languages(), (std::vector<std::string>{"en", "de", "fr"}));
}

TEST(Messages, AreFilledInOnceAndByWhatIsGiven) {
  const std::map<std::string, std::string> values{{"title", "{count} of {title}"}, {"count", "2"}};
  EXPECT_EQ(filled_in("{count}: {title}.", values), "2: {count} of {title}.");
  EXPECT_EQ(filled_in("{other} {count", values), "{other} {count");
}

}  // namespace
}  // namespace api
}  // namespace tractus

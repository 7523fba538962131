#pragma once
/// Whether a text is well-formed XML, as far as that goes without entities and namespaces.

#include <regex>
#include <string>
#include <vector>

namespace tightrope::charts {

/// "" if every element is closed in its turn, attributes are quoted and given once, and '&' and '<' stand for nothing
/// but XML; otherwise where it fails.
inline std::string xml_error(const std::string& text) {
  static const std::regex start_tag(R"re(<([A-Za-z][\w:-]*)((?:\s+[\w:-]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*(/?)>)re");
  static const std::regex attribute(R"re(([\w:-]+)\s*=\s*("[^"]*"|'[^']*'))re");
  static const std::regex end_tag(R"re(</([A-Za-z][\w:-]*)\s*>)re");
  static const std::regex reference(R"re(&(?:amp|lt|gt|quot|apos|#\d+);)re");
  std::vector<std::string> open;
  std::size_t at = 0;
  const auto here = [&] { return text.substr(at, 60); };
  const auto skip = [&](const std::string& begin, const std::string& end) {
    if (text.compare(at, begin.size(), begin) != 0) return false;
    const std::size_t found = text.find(end, at);
    at = found == std::string::npos ? text.size() : found + end.size();
    return true;
  };
  const auto matches = [&](const std::regex& pattern, std::smatch& match) {
    return std::regex_search(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), match, pattern,
                             std::regex_constants::match_continuous);
  };
  while (at < text.size()) {
    std::smatch match;
    if (text[at] == '&') {
      if (!matches(reference, match)) return "reference: " + here();
      at += static_cast<std::size_t>(match.length());
    } else if (text[at] != '<') {
      ++at;
    } else if (skip("<?", "?>") || skip("<![CDATA[", "]]>") || skip("<!--", "-->") || skip("<!DOCTYPE", ">")) {
      continue;
    } else if (matches(end_tag, match)) {
      if (open.empty() || open.back() != match[1]) return "end: " + here();
      open.pop_back();
      at += static_cast<std::size_t>(match.length());
    } else if (matches(start_tag, match)) {
      std::vector<std::string> names;
      const std::string attributes = match[2];
      for (std::sregex_iterator a(attributes.begin(), attributes.end(), attribute), end; a != end; ++a) {
        for (const std::string& name : names) {
          if (name == (*a)[1]) return "attribute twice: " + here();
        }
        names.push_back((*a)[1]);
        if (std::regex_search(a->str(), std::regex("&(?!(?:amp|lt|gt|quot|apos|#\\d+);)"))) return "'&': " + here();
      }
      if (match[3].length() == 0) open.push_back(match[1]);
      at += static_cast<std::size_t>(match.length());
    } else {
      return "tag: " + here();
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

}  // namespace tightrope::charts

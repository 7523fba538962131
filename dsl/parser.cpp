#include "dsl/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dsl/parse_expression.h"
#include "dsl/parse_parameters.h"
#include "dsl/parse_statement.h"
#include "dsl/token_cursor.h"

namespace tightrope::dsl {

namespace {

/// The `//` comments on the lines directly above `declaration`, which is the first token of its line.
std::string doc_comment(std::string_view text, const std::vector<Token>& comments, const Token& declaration) {
  const auto behind = std::lower_bound(comments.begin(), comments.end(), declaration.begin,
                                       [](const Token& comment, std::uint32_t begin) { return comment.begin < begin; });
  auto first = behind;
  std::uint32_t line = declaration.line;
  while (first != comments.begin() && declaration.starts_line) {
    const Token& comment = *std::prev(first);
    if (!comment.starts_line || comment.line + 1 != line) break;
    line = comment.line;
    --first;
  }
  std::string doc;
  for (auto comment = first; comment != behind && first != behind; ++comment) {
    std::string_view content = text.substr(comment->begin, comment->end - comment->begin);
    content.remove_prefix(std::min(content.find_first_not_of('/'), content.size()));
    if (content.starts_with(' ')) content.remove_prefix(1);
    content = content.substr(0, content.find_last_not_of(" \t\r") + 1);
    if (comment != first) doc += '\n';
    doc += content;
  }
  return doc;
}

class ModuleParser {
 public:
  ModuleParser(const SourceMap& sources, std::uint32_t file, TokenList tokens, Diagnostics& diagnostics)
      : text_(sources.file(file).text),
        comments_(std::move(tokens.line_comments)),
        cursor_(text_, file, std::move(tokens.tokens), diagnostics) {
    module_.file = file;
  }

  Module run() {
    while (!cursor_.at_end()) {
      if (cursor_.accept(TokenKind::semicolon)) continue;
      const Token first = cursor_.peek();
      if (!parse_one(declaration_kind())) {
        if (cursor_.peek().begin == first.begin) cursor_.take();
        cursor_.skip_to_declaration();
      }
    }
    return std::move(module_);
  }

 private:
  /// The current token's kind; a misspelt keyword before a name or string is reported and taken for what it is nearly.
  TokenKind declaration_kind() {
    const Token token = cursor_.peek();
    if (token.kind != TokenKind::identifier) return token.kind;
    if (!cursor_.at_name(1) && cursor_.kind(1) != TokenKind::string) return TokenKind::identifier;
    const TokenKind nearest = cursor_.nearest(declaration_keywords);
    if (nearest != TokenKind::identifier) {
      cursor_.expected_here("a declaration", fmt::format("did you mean `{}`?", spelling(nearest)));
    }
    return nearest;
  }

  bool parse_one(TokenKind kind) {
    if (kind == TokenKind::keyword_predicate) return parse_predicate();
    if (kind == TokenKind::keyword_function) return parse_function();
    if (kind == TokenKind::keyword_instance) return parse_instance();
    if (kind == TokenKind::keyword_import) return parse_import();
    if (kind == TokenKind::right_brace) {
      cursor_.error(cursor_.span(cursor_.peek()), "this `}` closes nothing");
      cursor_.take();
      return true;
    }
    cursor_.expected_here("`predicate`, `function`, `instance` or `import`");
    return false;
  }

  /// predicate name(parameters) { statements }
  bool parse_predicate() {
    PredicateDecl predicate;
    predicate.doc = doc_comment(text_, comments_, cursor_.take());
    const Token* name = cursor_.expect_name("the predicate's name");
    if (name != nullptr) {
      predicate.name = cursor_.text(*name);
      predicate.name_span = cursor_.span(*name);
      if (parse_parameters(cursor_, module_.exprs, true, predicate.parameters) &&
          cursor_.kind() != TokenKind::left_brace) {
        cursor_.expected("`{`", "a predicate is written `predicate name(scalar a, b) { sign a - b }`");
      }
    }
    const bool has_block = cursor_.skip_to_block();
    if (has_block) parse_block(cursor_, module_.exprs, {&predicate, nullptr}, predicate.body);
    if (name != nullptr) module_.predicates.push_back(std::move(predicate));
    return has_block;
  }

  /// function name(parameters) = expression, function name(parameters) { lets return expression }
  bool parse_function() {
    constexpr const char* hint = "a function is written `function f(a, b) = a + b`";
    FunctionDecl function;
    cursor_.take();
    const Token* name = cursor_.expect_name("the function's name");
    if (name == nullptr) return false;
    function.name = cursor_.text(*name);
    function.name_span = cursor_.span(*name);
    bool complete = parse_parameters(cursor_, module_.exprs, false, function.parameters);
    if (complete && cursor_.accept(TokenKind::equals)) {
      function.result = parse_expression(cursor_, module_.exprs);
      complete = !function.result.empty();
    } else {
      if (complete && cursor_.kind() != TokenKind::left_brace) cursor_.expected("`=` or `{`", hint);
      complete = cursor_.skip_to_block();
      if (complete) parse_block(cursor_, module_.exprs, {nullptr, &function}, function.body);
    }
    module_.functions.push_back(std::move(function));
    return complete;
  }

  /// instance name = predicate(a, b: static, p: moving)
  bool parse_instance() {
    constexpr const char* hint = "an instance is written `instance name = predicate(a, b: static)`";
    InstanceDecl instance;
    instance.doc = doc_comment(text_, comments_, cursor_.take());
    const Token* name = cursor_.expect_name("the instance's name");
    if (name == nullptr || !cursor_.expect(TokenKind::equals, hint)) return false;
    instance.name = cursor_.text(*name);
    instance.name_span = cursor_.span(*name);
    const Token* predicate = cursor_.expect_name("a predicate's name");
    if (predicate == nullptr) return false;
    instance.predicate = cursor_.text(*predicate);
    instance.predicate_span = cursor_.span(*predicate);
    const Token open = cursor_.peek();
    if (!cursor_.expect(TokenKind::left_parenthesis, hint)) return false;
    if (cursor_.kind() != TokenKind::right_parenthesis && !parse_changes(instance.changes)) return false;
    const bool complete = cursor_.expect_close(TokenKind::right_parenthesis, open);
    module_.instances.push_back(std::move(instance));
    return complete;
  }

  /// a, b: static, p: moving
  bool parse_changes(std::vector<InstanceDecl::Change>& changes) {
    std::size_t without_motion = 0;  // changes[without_motion..] wait for their `: motion`
    do {
      const Token* name = cursor_.expect_name("a parameter's name");
      if (name == nullptr) return false;
      changes.push_back({std::string(cursor_.text(*name)), cursor_.span(*name), ParameterDecl::Motion::fixed});
      if (!cursor_.accept(TokenKind::colon)) continue;
      if (cursor_.kind() != TokenKind::keyword_static && cursor_.kind() != TokenKind::keyword_moving) {
        cursor_.expected("`static` or `moving`");
        return false;
      }
      const bool moving = cursor_.take().kind == TokenKind::keyword_moving;
      for (; without_motion < changes.size(); ++without_motion) {
        changes[without_motion].motion = moving ? ParameterDecl::Motion::moving : ParameterDecl::Motion::fixed;
      }
    } while (cursor_.accept(TokenKind::comma));
    if (without_motion == changes.size()) return true;
    const std::string& last = changes.back().parameter;
    cursor_.expected(fmt::format("`: static` or `: moving` after {}", quote(last)));
    return false;
  }

  /// import "path"
  bool parse_import() {
    cursor_.take();
    if (cursor_.kind() != TokenKind::string) {
      cursor_.expected("a file's name in double quotes", "an import is written `import \"shapes.pred\"`");
      return false;
    }
    const Token path = cursor_.take();
    const std::string_view quoted_path = cursor_.text(path);
    const std::string_view name = quoted_path.substr(1, quoted_path.size() - 2);
    if (name.empty()) {
      cursor_.error(cursor_.span(path), "this import names no file");
    } else {
      module_.imports.push_back({std::string(name), cursor_.span(path)});
    }
    return true;
  }

  std::string_view text_;
  std::vector<Token> comments_;
  TokenCursor cursor_;
  Module module_;
};

}  // namespace

Module parse(const SourceMap& sources, std::uint32_t file, Diagnostics& diagnostics) {
  TokenList tokens = lex(sources, file, diagnostics);
  if (!tokens.complete) {
    Module module;
    module.file = file;
    return module;
  }
  return ModuleParser(sources, file, std::move(tokens), diagnostics).run();
}

}  // namespace tightrope::dsl

#include "dsl/parse_statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "dsl/parse_expression.h"

namespace tightrope::dsl {

bool parse_names(TokenCursor& cursor, std::string_view what, NameList& names) {
  do {
    const Token* name = cursor.expect_name(what);
    if (name == nullptr) return false;
    names.emplace_back(cursor.text(*name), cursor.span(*name));
  } while (cursor.accept(TokenKind::comma));
  return true;
}

namespace {

/// The statements of one block. Each parse_... function takes one statement, from its keyword on; it returns false
/// where the cursor stands at an error and has to be moved to the next statement.
class BlockParser {
 public:
  BlockParser(TokenCursor& cursor, std::vector<Expr>& exprs, const BlockContext& context, std::vector<Statement>& body)
      : cursor_(cursor), exprs_(exprs), context_(context), body_(body) {}

  void run() {
    bool returned = false;
    while (!cursor_.at_end() && cursor_.kind() != TokenKind::right_brace && !cursor_.at_declaration()) {
      if (cursor_.accept(TokenKind::semicolon)) continue;
      const Token first = cursor_.peek();
      if (returned) cursor_.expected_here("`}` after the function's `return`");
      const std::size_t before = body_.size();
      const bool parsed = parse_one(statement_kind());
      const bool complete = parsed && at_statement_end();
      if (parsed && !complete && body_.size() > before) drop_expression();
      if (!complete) {
        if (cursor_.peek().begin == first.begin) cursor_.take();
        cursor_.skip_to_statement();
      }
      returned = returned || (first.kind == TokenKind::keyword_return && context_.function != nullptr);
    }
    if (!returned && context_.function != nullptr && context_.top_level()) {
      cursor_.expected("`return` with the function's value");
    }
  }

 private:
  /// The current token's kind; a misspelt keyword is reported and taken for the one it is nearly.
  TokenKind statement_kind() {
    const Token token = cursor_.peek();
    if (token.kind != TokenKind::identifier || cursor_.at_normalize()) return token.kind;
    if (cursor_.kind(1) == TokenKind::equals) {
      cursor_.expected_here("a statement", fmt::format("a name is bound with `let {} = ...`", cursor_.text(token)));
      return TokenKind::identifier;
    }
    const TokenKind nearest = cursor_.nearest(statement_keywords);
    if (nearest != TokenKind::identifier) {
      cursor_.expected_here("a statement", fmt::format("did you mean `{}`?", spelling(nearest)));
    }
    return nearest;
  }

  bool parse_one(TokenKind kind) {
    if (kind == TokenKind::keyword_let) return parse_let();
    if (kind == TokenKind::keyword_sign) return parse_outputs(StatementKind::sign);
    if (kind == TokenKind::keyword_value) return parse_outputs(StatementKind::value);
    if (kind == TokenKind::keyword_for) return parse_for();
    if (kind == TokenKind::keyword_stage) return parse_stage();
    if (kind == TokenKind::keyword_range) return parse_range();
    if (kind == TokenKind::keyword_group) return parse_group();
    if (kind == TokenKind::keyword_property) return parse_property();
    if (kind == TokenKind::keyword_return) return parse_return();
    if (cursor_.at_normalize()) return parse_normalize();
    cursor_.expected_here(context_.function != nullptr ? "`let`, `for`, `return` or `}`"
                          : context_.top_level()
                              ? "`let`, `sign`, `value`, `for`, `stage`, `range`, `group`, `property` or `}`"
                              : "`let`, `sign`, `value`, `for` or `}`");
    return false;
  }

  /// Whether a statement may end before the current token. A token on a line of its own is the next statement's matter.
  bool at_statement_end() {
    const TokenKind kind = cursor_.kind();
    if (cursor_.peek().starts_line || cursor_.at_end() || kind == TokenKind::right_brace ||
        kind == TokenKind::semicolon || cursor_.at_statement()) {
      return true;
    }
    const bool operand = cursor_.at_name() || kind == TokenKind::number || kind == TokenKind::left_parenthesis;
    cursor_.expected("the end of the statement", operand ? "a product is written `a * b`" : "");
    return false;
  }

  /// The last statement's expression has a tail that could not be read, so it is not what the user meant.
  void drop_expression() {
    Statement& last = body_.back();
    if (last.kind == StatementKind::let) last.expr = {};
    if (last.kind == StatementKind::sign || last.kind == StatementKind::value) body_.pop_back();
  }

  /// A statement whose place is the last keyword taken.
  Statement statement(StatementKind kind) const {
    Statement result;
    result.kind = kind;
    result.span = result.name_span = cursor_.span(cursor_.previous());
    return result;
  }

  void set_name(Statement& statement, const Token& name) const {
    statement.name = cursor_.text(name);
    statement.name_span = cursor_.span(name);
  }

  /// Reports a statement that may not stand in this block, at its keyword.
  void misplaced(std::string message) { cursor_.error(cursor_.span(cursor_.previous()), std::move(message)); }

  bool parse_let() {
    const std::uint32_t begin = cursor_.take().begin;
    Statement let = statement(StatementKind::let);
    const Token* name = cursor_.expect_name("a name after `let`");
    if (name == nullptr) return false;
    set_name(let, *name);
    bool complete = cursor_.expect(TokenKind::equals, "a name is bound with `let x = ...`");
    if (complete) {
      let.expr = parse_expression(cursor_, exprs_);
      complete = !let.expr.empty();
    }
    let.span = cursor_.since(begin);
    body_.push_back(std::move(let));  // even if incomplete: the name exists
    return complete;
  }

  /// `sign E [as name], ...`: a statement for each expression.
  bool parse_outputs(StatementKind kind) {
    cursor_.take();
    if (context_.function != nullptr) misplaced("a function has no outputs; `sign` and `value` belong to predicates");
    do {
      Statement output = statement(kind);
      const std::uint32_t begin = cursor_.peek().begin;
      output.expr = parse_expression(cursor_, exprs_);
      if (output.expr.empty()) return false;
      output.span = output.name_span = cursor_.since(begin);
      if (cursor_.accept(TokenKind::keyword_as)) {
        const Token* name = cursor_.expect_name("the output's name after `as`");
        if (name == nullptr) return false;
        set_name(output, *name);
        output.span = cursor_.since(begin);
      }
      if (context_.function == nullptr) body_.push_back(std::move(output));
    } while (cursor_.accept(TokenKind::comma));
    return true;
  }

  bool parse_for() {
    constexpr const char* hint = "a loop is written `for i in 0..3 { ... }`";
    const std::uint32_t begin = cursor_.take().begin;
    Statement loop = statement(StatementKind::for_loop);
    const Token* name = cursor_.expect_name("the name of the loop's variable");
    if (name != nullptr) set_name(loop, *name);
    bool complete = name != nullptr && cursor_.expect(TokenKind::keyword_in, hint);
    if (complete) {
      loop.first = parse_expression(cursor_, exprs_);
      complete = !loop.first.empty() && cursor_.expect(TokenKind::dot_dot, hint);
    }
    if (complete) {
      loop.last = parse_expression(cursor_, exprs_);
      complete = !loop.last.empty();
    }
    if (complete && cursor_.kind() != TokenKind::left_brace) cursor_.expected("`{`", hint);
    if (!cursor_.skip_to_block()) return false;
    BlockContext inner = context_;
    inner.in_loop = true;
    parse_block(cursor_, exprs_, inner, loop.body);
    loop.span = cursor_.since(begin);
    body_.push_back(std::move(loop));
    return true;
  }

  bool parse_stage() {
    const std::uint32_t begin = cursor_.take().begin;
    Statement stage = statement(StatementKind::stage);
    const bool allowed = context_.function == nullptr && context_.top_level();
    if (!allowed) misplaced("a `stage` stands at the top level of a predicate only");
    const Token* name = cursor_.expect_name("the stage's name");
    if (name != nullptr) set_name(stage, *name);
    if (name != nullptr && cursor_.kind() != TokenKind::left_brace) {
      cursor_.expected("`{`", "a stage is written `stage name { ... }`");
    }
    BlockContext inner = context_;
    inner.in_stage = true;
    if (cursor_.skip_to_block()) {
      parse_block(cursor_, exprs_, inner, stage.body);
    } else if (name != nullptr && cursor_.at_statement()) {  // the `{` is missing, the `}` probably not
      parse_statements(cursor_, exprs_, inner, stage.body);
      cursor_.accept(TokenKind::right_brace);
    } else {
      return false;
    }
    stage.span = cursor_.since(begin);
    if (allowed) {
      body_.push_back(std::move(stage));
    } else {  // its names exist all the same
      std::copy_if(stage.body.begin(), stage.body.end(), std::back_inserter(body_),
                   [](const Statement& s) { return s.kind == StatementKind::let; });
    }
    return true;
  }

  /// `range |a, b| <= limit`
  bool parse_range() {
    constexpr const char* hint = "a range is written `range |a, b| <= 4`";
    const std::uint32_t begin = cursor_.take().begin;
    require_top_level_of_predicate();
    RangeDecl range;
    if (!cursor_.expect(TokenKind::bar, hint) || !parse_names(cursor_, "a parameter's name", range.names) ||
        !cursor_.expect(TokenKind::bar, hint) || !cursor_.expect(TokenKind::less_or_equal, hint)) {
      return false;
    }
    range.limit = parse_expression(cursor_, exprs_);
    if (range.limit.empty()) return false;
    range.span = cursor_.since(begin);
    if (context_.predicate != nullptr) context_.predicate->ranges.push_back(std::move(range));
    return true;
  }

  /// `normalize a, b`
  bool parse_normalize() {
    const std::uint32_t begin = cursor_.take().begin;
    require_top_level_of_predicate();
    NormalizeDecl normalize;
    if (!parse_names(cursor_, "a parameter's name", normalize.names)) return false;
    normalize.span = cursor_.since(begin);
    if (context_.predicate != nullptr) context_.predicate->normalizations.push_back(std::move(normalize));
    return true;
  }

  /// `group all`, `group axis`, `group displacements`, `group (a, b), (c)`, or several of these.
  bool parse_group() {
    const std::uint32_t begin = cursor_.take().begin;
    require_top_level_of_predicate();
    GroupDecl group;
    do {
      const Token open = cursor_.peek();
      if (cursor_.accept(TokenKind::left_parenthesis)) {
        if (!parse_names(cursor_, "a parameter's name", group.lists.emplace_back()) ||
            !cursor_.expect_close(TokenKind::right_parenthesis, open)) {
          return false;
        }
        continue;
      }
      const Token* word = cursor_.expect_name("`all`, `axis`, `displacements` or parameters in parentheses");
      if (word == nullptr) return false;
      group.words.emplace_back(cursor_.text(*word), cursor_.span(*word));
    } while (cursor_.accept(TokenKind::comma));
    group.span = cursor_.since(begin);
    if (context_.predicate != nullptr) context_.predicate->groups.push_back(std::move(group));
    return true;
  }

  /// `property name`, `property name(a, b)`, `property name(3)`, each with or without `of outputs`.
  bool parse_property() {
    cursor_.take();
    require_top_level_of_predicate();
    PropertyDecl property;
    const Token* name = cursor_.expect_name("the property's name");
    if (name == nullptr) return false;
    property.name = cursor_.text(*name);
    const Token open = cursor_.peek();
    if (cursor_.accept(TokenKind::left_parenthesis)) {
      if (cursor_.at_name()) {
        if (!parse_names(cursor_, "a parameter's name", property.arguments)) return false;
      } else {
        property.number = parse_expression(cursor_, exprs_);
        if (property.number.empty()) return false;
      }
      if (!cursor_.expect_close(TokenKind::right_parenthesis, open)) return false;
    }
    property.span = cursor_.since(name->begin);
    if (cursor_.accept(TokenKind::keyword_of) && !parse_names(cursor_, "an output's name", property.outputs))
      return false;
    if (context_.predicate != nullptr) context_.predicate->properties.push_back(std::move(property));
    return true;
  }

  void require_top_level_of_predicate() {
    if (context_.function != nullptr || !context_.top_level()) {
      misplaced(fmt::format("`{}` stands at the top level of a predicate only", cursor_.text(cursor_.previous())));
    }
  }

  bool parse_return() {
    cursor_.take();
    if (context_.function == nullptr) {
      misplaced("a predicate returns nothing; its outputs are given with `sign` and `value`");
    } else if (!context_.top_level()) {
      misplaced("`return` ends a function; it cannot stand in a loop");
    }
    const ExprRange result = parse_expression(cursor_, exprs_);
    if (context_.function != nullptr && context_.top_level()) context_.function->result = result;
    return !result.empty();
  }

  TokenCursor& cursor_;
  std::vector<Expr>& exprs_;
  const BlockContext& context_;
  std::vector<Statement>& body_;
};

}  // namespace

void parse_statements(TokenCursor& cursor, std::vector<Expr>& exprs, const BlockContext& context,
                      std::vector<Statement>& body) {
  BlockParser(cursor, exprs, context, body).run();
}

void parse_block(TokenCursor& cursor, std::vector<Expr>& exprs, const BlockContext& context,
                 std::vector<Statement>& body) {
  const Nesting nesting(cursor, "");
  if (!nesting) return cursor.skip_block();
  const Token open = cursor.take();
  parse_statements(cursor, exprs, context, body);
  cursor.expect_close(TokenKind::right_brace, open);
}

}  // namespace tightrope::dsl

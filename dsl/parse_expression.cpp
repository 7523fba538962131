#include "dsl/parse_expression.h"

#include <fmt/format.h>

#include <utility>

namespace tightrope::dsl {

namespace {

/// How tightly an operator binds; the loosest first.
enum class Power { at, sum, product, power, none };

struct Infix {
  Power power;
  ExprKind kind;
};

Infix infix_operator(TokenKind kind) {
  if (kind == TokenKind::keyword_at) return {Power::at, ExprKind::at};
  if (kind == TokenKind::plus) return {Power::sum, ExprKind::add};
  if (kind == TokenKind::minus) return {Power::sum, ExprKind::subtract};
  if (kind == TokenKind::star) return {Power::product, ExprKind::multiply};
  if (kind == TokenKind::slash) return {Power::product, ExprKind::divide};
  if (kind == TokenKind::caret) return {Power::power, ExprKind::power};
  return {Power::none, ExprKind::number};
}

/// A parsed operand: its root node and where it stands, parentheses included. No node after an error.
struct Operand {
  ExprId root = no_expr;
  std::uint32_t begin = 0;
  bool parenthesised = false;
  explicit operator bool() const { return root != no_expr; }
};

/// Long chains of operators of one precedence are loops; what recurses here is counted by TokenCursor::enter.
class ExpressionParser {
 public:
  ExpressionParser(TokenCursor& cursor, std::vector<Expr>& exprs) : cursor_(cursor), exprs_(exprs) {}

  /// Operands joined by operators that bind at least as tightly as `loosest`.
  Operand parse(Power loosest) {
    Operand left = parse_prefix();
    while (left) {
      const Infix infix = infix_operator(cursor_.kind());
      if (infix.power == Power::none || infix.power < loosest) break;
      cursor_.take();
      if (infix.power == Power::at) {
        left = parse_at(left);
      } else if (infix.power == Power::power) {
        left = parse_power(left);
      } else {
        const Operand right = parse(infix.power == Power::sum ? Power::product : Power::power);
        left = right ? add_node(infix.kind, left.begin, {left.root, right.root}) : right;
      }
    }
    return left;
  }

 private:
  /// A node whose text runs from byte `begin` to the last token taken.
  Operand add_node(ExprKind kind, std::uint32_t begin, std::vector<ExprId> operands, std::string_view text = {}) {
    Expr& expr = exprs_.emplace_back();
    expr.kind = kind;
    expr.span = cursor_.since(begin);
    expr.text = text;
    expr.operands = std::move(operands);
    return {static_cast<ExprId>(exprs_.size()) - 1, begin};
  }

  /// If the operand just parsed is a quotient r/s without parentheses of its own: removes the quotient's node, which
  /// is the last one, and leaves r and s.
  bool take_quotient(const Operand& operand, ExprId& r, ExprId& s) {
    const Expr& root = exprs_[static_cast<std::size_t>(operand.root)];
    if (operand.parenthesised || root.kind != ExprKind::divide) return false;
    r = root.operands[0];
    s = root.operands[1];
    exprs_.pop_back();
    return true;
  }

  /// P at s, P at r/s. What follows the product on the right would read as part of it, so `P at s + Q` is an error.
  Operand parse_at(const Operand& left) {
    const Operand right = parse(Power::product);
    if (!right) return right;
    if (cursor_.kind() == TokenKind::plus || cursor_.kind() == TokenKind::minus) {
      cursor_.error(
          cursor_.span(cursor_.peek()),
          fmt::format("`at` takes a product: what {} belongs to is unclear", quote(cursor_.text(cursor_.peek()))),
          "write `(P at s) + Q` or `P at (s + q)`");
      return {};
    }
    ExprId r = no_expr, s = no_expr;
    if (take_quotient(right, r, s)) return add_node(ExprKind::at_ratio, left.begin, {left.root, r, s});
    return add_node(ExprKind::at, left.begin, {left.root, right.root});
  }

  /// a ^ b, from the right: a ^ b ^ c is a ^ (b ^ c).
  Operand parse_power(const Operand& left) {
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const Operand right = parse(Power::power);
    return right ? add_node(ExprKind::power, left.begin, {left.root, right.root}) : right;
  }

  Operand parse_prefix() {
    if (cursor_.kind() != TokenKind::minus) return parse_postfix();
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const std::uint32_t begin = cursor_.take().begin;
    const Operand operand = parse(Power::power);
    return operand ? add_node(ExprKind::negate, begin, {operand.root}) : operand;
  }

  Operand parse_postfix() {
    Operand left = parse_primary();
    while (left) {
      if (cursor_.kind() == TokenKind::left_bracket) {
        left = parse_index(left);
      } else if (cursor_.kind() == TokenKind::dot) {
        left = parse_component(left);
      } else {
        break;
      }
    }
    return left;
  }

  Operand parse_index(const Operand& left) {
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const Token open = cursor_.take();
    const Operand index = parse(Power::at);
    if (!index || !cursor_.expect_close(TokenKind::right_bracket, open)) return {};
    return add_node(ExprKind::index, left.begin, {left.root, index.root});
  }

  Operand parse_component(const Operand& left) {
    cursor_.take();
    const std::string_view name = cursor_.text(cursor_.peek());
    if (name != "x" && name != "y" && name != "z") {
      cursor_.expected("a component `x`, `y` or `z` after `.`");
      return {};
    }
    cursor_.take();
    return add_node(ExprKind::component, left.begin, {left.root}, name);
  }

  Operand parse_primary() {
    const Token token = cursor_.peek();
    if (token.kind == TokenKind::number) {
      cursor_.take();
      return add_node(ExprKind::number, token.begin, {}, cursor_.text(token));
    }
    if (token.kind == TokenKind::left_parenthesis) return parse_parentheses();
    if (token.kind == TokenKind::left_bracket) return parse_array();
    const bool builds_vector = token.kind == TokenKind::keyword_vec2 || token.kind == TokenKind::keyword_vec3;
    if (cursor_.at_name() || (builds_vector && cursor_.kind(1) == TokenKind::left_parenthesis)) {
      cursor_.take();
      if (cursor_.kind() == TokenKind::left_parenthesis) return parse_call(token);
      return add_node(ExprKind::name, token.begin, {}, cursor_.text(token));
    }
    return fail_primary(token);
  }

  Operand fail_primary(const Token& token) {
    std::string hint;
    if (token.kind == TokenKind::plus) hint = "leave the `+` out";
    if (token.kind == TokenKind::bar) hint = "an absolute value is written `abs(x)`";
    if (is_keyword(token.kind) && !token.starts_line) {
      hint = fmt::format("{} is a keyword and cannot be a name", quote(cursor_.text(token)));
    }
    cursor_.expected("an expression", std::move(hint));
    return {};
  }

  Operand parse_parentheses() {
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const Token open = cursor_.take();
    Operand inner = parse(Power::at);
    if (!inner || !cursor_.expect_close(TokenKind::right_parenthesis, open)) return {};
    inner.begin = open.begin;
    inner.parenthesised = true;
    return inner;
  }

  Operand parse_call(const Token& name) {
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const Token open = cursor_.take();
    std::vector<ExprId> arguments;
    Operand last;
    if (cursor_.kind() != TokenKind::right_parenthesis) {
      do {
        last = parse(Power::at);
        if (!last) return {};
        arguments.push_back(last.root);
      } while (cursor_.accept(TokenKind::comma));
    }
    if (!cursor_.expect_close(TokenKind::right_parenthesis, open)) return {};
    const std::string_view text = cursor_.text(name);
    ExprId r = no_expr, s = no_expr;
    if (text == "split" && arguments.size() == 2 && take_quotient(last, r, s)) {
      return add_node(ExprKind::split_ratio, name.begin, {arguments[0], r, s}, text);
    }
    return add_node(ExprKind::call, name.begin, std::move(arguments), text);
  }

  /// [a, b, c] and [body for i in first..last].
  Operand parse_array() {
    const Nesting nesting(cursor_);
    if (!nesting) return {};
    const Token open = cursor_.take();
    const auto body_begin = static_cast<ExprId>(exprs_.size());
    std::vector<ExprId> elements;
    do {
      const Operand element = parse(Power::at);
      if (!element) return {};
      elements.push_back(element.root);
      if (elements.size() == 1 && cursor_.kind() == TokenKind::keyword_for)
        return parse_comprehension(open, body_begin);
    } while (cursor_.accept(TokenKind::comma));
    if (!cursor_.expect_close(TokenKind::right_bracket, open)) return {};
    return add_node(ExprKind::array, open.begin, std::move(elements));
  }

  Operand parse_comprehension(const Token& open, ExprId body_begin) {
    constexpr const char* hint = "an array is made with `[f(i) for i in 0..3]`";
    const auto body_end = static_cast<ExprId>(exprs_.size());
    cursor_.take();
    const Token* variable = cursor_.expect_name("the name of the loop's variable");
    if (variable == nullptr || !cursor_.expect(TokenKind::keyword_in, hint)) return {};
    const Operand first = parse(Power::sum);
    if (!first || !cursor_.expect(TokenKind::dot_dot, hint)) return {};
    const Operand last = parse(Power::sum);
    if (!last || !cursor_.expect_close(TokenKind::right_bracket, open)) return {};
    const Operand array =
        add_node(ExprKind::comprehension, open.begin, {first.root, last.root}, cursor_.text(*variable));
    exprs_.back().body_begin = body_begin;
    exprs_.back().body_end = body_end;
    return array;
  }

  TokenCursor& cursor_;
  std::vector<Expr>& exprs_;
};

}  // namespace

ExprRange parse_expression(TokenCursor& cursor, std::vector<Expr>& exprs) {
  const auto begin = static_cast<ExprId>(exprs.size());
  if (ExpressionParser(cursor, exprs).parse(Power::at)) return {begin, static_cast<ExprId>(exprs.size())};
  exprs.erase(exprs.begin() + begin, exprs.end());
  return {begin, begin};
}

}  // namespace tightrope::dsl

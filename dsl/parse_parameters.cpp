#include "dsl/parse_parameters.h"

#include <fmt/format.h>

#include <array>

#include "dsl/parse_expression.h"

namespace tightrope::dsl {

namespace {

struct TypeName {
  TokenKind keyword;
  ParameterDecl::Kind kind;
};

constexpr std::array<TypeName, 5> type_names{{
    {TokenKind::keyword_scalar, ParameterDecl::Kind::scalar},
    {TokenKind::keyword_vec2, ParameterDecl::Kind::vec2},
    {TokenKind::keyword_vec3, ParameterDecl::Kind::vec3},
    {TokenKind::keyword_point, ParameterDecl::Kind::point},
    {TokenKind::keyword_point2, ParameterDecl::Kind::point2},
}};

class ParameterParser {
 public:
  ParameterParser(TokenCursor& cursor, std::vector<Expr>& exprs, bool typed)
      : cursor_(cursor), exprs_(exprs), type_needed_(typed) {}

  bool parse(std::vector<ParameterDecl>& parameters) {
    const Token open = cursor_.peek();
    if (!cursor_.expect(TokenKind::left_parenthesis, "parameters are written `(point p, q, scalar s)`")) return false;
    if (cursor_.accept(TokenKind::right_parenthesis)) return true;
    do {
      if (!parse_one(parameters)) skip_to_separator();
    } while (cursor_.accept(TokenKind::comma));
    return cursor_.expect_close(TokenKind::right_parenthesis, open);
  }

 private:
  /// [type] name[extent]...; `type_` stays in force for the names that follow.
  bool parse_one(std::vector<ParameterDecl>& parameters) {
    parse_type();
    const Token* name = cursor_.expect_name("a parameter's name");
    if (name == nullptr) return false;
    ParameterDecl parameter = type_;
    parameter.name = cursor_.text(*name);
    parameter.span = cursor_.span(*name);
    if (type_needed_ && parameter.kind == ParameterDecl::Kind::unspecified) {
      cursor_.error(parameter.span, fmt::format("the parameter {} has no type", quote(parameter.name)),
                    fmt::format("write `point {0}`, `vec3 {0}` or `scalar {0}`", parameter.name));
      type_needed_ = false;  // said once
    }
    bool complete = true;
    while (complete && cursor_.kind() == TokenKind::left_bracket) {
      const Token open = cursor_.take();
      parameter.array.push_back(parse_expression(cursor_, exprs_));
      complete = !parameter.array.back().empty() && cursor_.expect_close(TokenKind::right_bracket, open);
    }
    parameters.push_back(std::move(parameter));
    if (complete && cursor_.kind() != TokenKind::comma && cursor_.kind() != TokenKind::right_parenthesis) {
      cursor_.expected(fmt::format("`,` or `)` after the parameter {}", quote(parameters.back().name)));
      complete = false;
    }
    return complete;
  }

  /// [bounded] [moving|static] kind, if there is one here.
  void parse_type() {
    if (cursor_.kind() == TokenKind::identifier && cursor_.at_name(1)) return report_unknown_type();
    ParameterDecl type;
    bool qualified = false;
    for (;; qualified = true) {
      if (!type.bounded && cursor_.accept(TokenKind::keyword_bounded)) {
        type.bounded = true;
      } else if (type.motion == ParameterDecl::Motion::unspecified && cursor_.accept(TokenKind::keyword_moving)) {
        type.motion = ParameterDecl::Motion::moving;
      } else if (type.motion == ParameterDecl::Motion::unspecified && cursor_.accept(TokenKind::keyword_static)) {
        type.motion = ParameterDecl::Motion::fixed;
      } else {
        break;
      }
    }
    for (const TypeName& name : type_names) {
      if (!cursor_.accept(name.keyword)) continue;
      type.kind = name.kind;
      type_ = type;
      return;
    }
    if (!qualified) return;
    cursor_.expected("a type (`scalar`, `vec2`, `vec3`, `point` or `point2`)");
    type_ = type;
    type_needed_ = false;
  }

  /// `Point p`: a name where a type belongs.
  void report_unknown_type() {
    static constexpr std::array keywords = {
        TokenKind::keyword_scalar, TokenKind::keyword_vec2,    TokenKind::keyword_vec3,   TokenKind::keyword_point,
        TokenKind::keyword_point2, TokenKind::keyword_bounded, TokenKind::keyword_moving, TokenKind::keyword_static};
    const TokenKind nearest = cursor_.nearest(keywords);
    cursor_.error(cursor_.span(cursor_.peek()), fmt::format("unknown type {}", quote(cursor_.text(cursor_.peek()))),
                  nearest == TokenKind::identifier ? "the types are `scalar`, `vec2`, `vec3`, `point` and `point2`"
                                                   : fmt::format("did you mean `{}`?", spelling(nearest)));
    cursor_.take();
    type_ = {};
    type_needed_ = false;
  }

  /// To the `,` or `)` that ends the parameter, or to what ends the list without one.
  void skip_to_separator() {
    int open = 0;
    while (!cursor_.at_end() && !cursor_.at_statement()) {
      const TokenKind kind = cursor_.kind();
      if (kind == TokenKind::left_brace || kind == TokenKind::right_brace || kind == TokenKind::equals) return;
      if (open == 0 && (kind == TokenKind::comma || kind == TokenKind::right_parenthesis)) return;
      if (kind == TokenKind::left_parenthesis || kind == TokenKind::left_bracket) ++open;
      if ((kind == TokenKind::right_parenthesis || kind == TokenKind::right_bracket) && open > 0) --open;
      cursor_.take();
    }
  }

  TokenCursor& cursor_;
  std::vector<Expr>& exprs_;
  bool type_needed_;
  ParameterDecl type_;
};

}  // namespace

bool parse_parameters(TokenCursor& cursor, std::vector<Expr>& exprs, bool typed,
                      std::vector<ParameterDecl>& parameters) {
  return ParameterParser(cursor, exprs, typed).parse(parameters);
}

}  // namespace tightrope::dsl

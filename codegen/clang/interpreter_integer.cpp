/// Whole numbers of an imported function, in the types that they have in C++.

#include "codegen/clang/interpreter.h"

namespace tightrope::codegen {

/// The mathematical result of one operation as a value of its type: modulo 2^width if that is unsigned. Signed overflow
/// has no meaning (of conversions: not one that code should rest on), and is refused; so is what no int64 holds.
Value Interpreter::whole(WideInteger result, clang::QualType type, clang::SourceLocation where) const {
  if (const auto* enumeration = type->getAs<clang::EnumType>()) type = enumeration->getDecl()->getIntegerType();
  if (type.isNull() || !type->isIntegerType()) throw ImportError{where, "a whole number of another type"};
  if (type->isBooleanType()) return Value::whole(result != 0 ? 1 : 0);
  const auto width = static_cast<int>(context_.getIntWidth(type));
  if (width > 64) throw ImportError{where, "a whole number of more than 64 bits"};
  const bool is_unsigned = type->isUnsignedIntegerType();
  const WideInteger range = WideInteger{1} << (is_unsigned ? width : width - 1);
  if (is_unsigned) result &= range - 1;
  if (result >= range || result < -range || result > INT64_MAX) {
    throw ImportError{where, "a whole number beyond the range of its type, or of a signed one of 64 bits"};
  }
  return Value::whole(static_cast<std::int64_t>(result));
}

/// What Clang evaluated.
Value Interpreter::whole(const llvm::APSInt& value, clang::SourceLocation where) const {
  const bool fits = value.isUnsigned() ? value.getActiveBits() <= 63 : value.getMinSignedBits() <= 64;
  if (!fits) throw ImportError{where, "a whole number beyond the range of a signed one of 64 bits"};
  return Value::whole(value.getExtValue());
}

/// Some elements on.
Place Interpreter::moved(Place place, std::int64_t elements, std::int64_t size, clang::SourceLocation where) {
  const WideInteger offset = WideInteger{place.offset} + WideInteger{elements} * size;
  constexpr std::int64_t farthest = 100'000'000;
  if (offset > farthest || offset < -farthest) throw ImportError{where, "a pointer far beyond its object"};
  return {place.object, static_cast<std::int64_t>(offset)};
}

/// The operands are converted already: to one type but for shifts, which are of the left one's.
Value Interpreter::apply_to_integers(clang::BinaryOperatorKind operation, std::int64_t x, std::int64_t y,
                                     clang::QualType result_type, clang::SourceLocation where) {
  const WideInteger wide = x;
  switch (static_cast<int>(operation)) {
    case clang::BO_Add:
      return whole(wide + y, result_type, where);
    case clang::BO_Sub:
      return whole(wide - y, result_type, where);
    case clang::BO_Mul:
      return whole(wide * y, result_type, where);
    case clang::BO_Div:
    case clang::BO_Rem: {
      if (y == 0) throw ImportError{where, "a division by zero"};
      const Value quotient = whole(wide / y, result_type, where);  // of a remainder, too, it must be there
      return operation == clang::BO_Div ? quotient : whole(wide % y, result_type, where);
    }
    case clang::BO_LT:
      return Value::whole(x < y);
    case clang::BO_GT:
      return Value::whole(x > y);
    case clang::BO_LE:
      return Value::whole(x <= y);
    case clang::BO_GE:
      return Value::whole(x >= y);
    case clang::BO_EQ:
      return Value::whole(x == y);
    case clang::BO_NE:
      return Value::whole(x != y);
    case clang::BO_And:
      return whole(x & y, result_type, where);
    case clang::BO_Or:
      return whole(x | y, result_type, where);
    case clang::BO_Xor:
      return whole(x ^ y, result_type, where);
    case clang::BO_Shl:
    case clang::BO_Shr:
      if (x < 0) throw ImportError{where, "a shift of a negative number"};
      if (y < 0 || y > 63 || y >= static_cast<std::int64_t>(context_.getIntWidth(result_type))) {
        throw ImportError{where, "a shift by more than the type's width"};
      }
      return whole(operation == clang::BO_Shl ? wide << y : wide >> y, result_type, where);
    default:
      throw ImportError{where, "this operator cannot be followed"};
  }
}

}  // namespace tightrope::codegen

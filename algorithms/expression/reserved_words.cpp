// SPDX-License-Identifier: MIT
#include "algorithms/expression/reserved_words.hpp"

#include <array>

namespace tribench {
namespace {

// Each list stands between blanks.
constexpr std::string_view kC =
    // C23 and C++20 keywords
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t"
    " char32_t class co_await co_return co_yield compl concept const const_cast consteval constexpr"
    " constinit continue decltype default delete do double dynamic_cast else enum explicit export"
    " extern false float for friend goto if inline int long mutable namespace new noexcept not"
    " not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires"
    " restrict return short signed sizeof static static_assert static_cast struct switch template"
    " this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned"
    " using virtual void volatile wchar_t while xor xor_eq main"
    // macros of compilers for one kind of machine each
    " unix linux i386 sun sparc mips vax m68k mc68000 hpux sgi arm PPC PDP11 near far huge pascal"
    // math.h
    " NAN INFINITY HUGE HUGE_VAL HUGE_VALF HUGE_VALL SNAN SNANF SNANL MAXFLOAT MATH_ERRNO"
    " MATH_ERREXCEPT math_errhandling signgam FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL"
    " FP_ILOGB0 FP_ILOGBNAN FP_FAST_FMA FP_FAST_FMAF FP_FAST_FMAL M_E M_LOG2E M_LOG10E M_LN2 M_LN10"
    " M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 DOMAIN SING OVERFLOW UNDERFLOW"
    " PLOSS TLOSS X_TLOSS exception float_t double_t isless islessequal islessgreater isgreater"
    " isgreaterequal isunordered isnormal isfinite isnan isinf signbit fpclassify iscanonical"
    " issignaling issubnormal iszero iseqsig signgam FP_LLOGB0 FP_LLOGBNAN FP_INT_UPWARD"
    " FP_INT_DOWNWARD FP_INT_TOWARDZERO FP_INT_TONEARESTFROMZERO FP_INT_TONEAREST HUGE_VAL_F32"
    " HUGE_VAL_F32X HUGE_VAL_F64 HUGE_VAL_F64X HUGE_VAL_F128 SNANF32 SNANF32X SNANF64 SNANF64X"
    " SNANF128"
    // what C++'s math.h has besides
    " NULL RAND_MAX EXIT_FAILURE EXIT_SUCCESS MB_CUR_MAX alloca BIG_ENDIAN LITTLE_ENDIAN PDP_ENDIAN"
    " BYTE_ORDER FD_CLR FD_ISSET FD_SET FD_SETSIZE FD_ZERO NFDBITS WCONTINUED WEXITED WEXITSTATUS"
    " WIFCONTINUED WIFEXITED WIFSIGNALED WIFSTOPPED WNOHANG WNOWAIT WSTOPPED WSTOPSIG WTERMSIG"
    " WUNTRACED be16toh be32toh be64toh htobe16 htobe32 htobe64 le16toh le32toh le64toh htole16"
    " htole32 htole64"
    // macros of headers that may stand before the code in one file
    " I complex imaginary errno EOF BUFSIZ stdin stdout stderr assert offsetof CHAR_BIT INT_MAX"
    " INT_MIN DBL_MAX DBL_MIN DBL_EPSILON FLT_MAX FLT_MIN FLT_EPSILON ";

// Functions of math.h, each also with f or l behind.
constexpr std::string_view kMath =
    " acos asin atan atan2 cos sin tan sincos acosh asinh atanh cosh sinh tanh exp exp2 exp10 expm1"
    " frexp ldexp log log10 log1p log2 logb modf pow sqrt hypot cbrt ceil fabs floor fmod drem"
    " significand copysign nan j0 j1 jn y0 y1 yn erf erfc lgamma lgamma_r tgamma gamma rint"
    " nextafter nexttoward nextup nextdown remainder scalb scalbn scalbln ilogb llogb nearbyint"
    " round roundeven trunc remquo lrint llrint lround llround fdim fmax fmin fma fmaximum fminimum"
    " finite canonicalize pow10 ufromfp fromfp getpayload setpayload totalorder ";

constexpr std::string_view kPython =
    " False None True and as assert async await break class continue def del elif else except"
    " finally for from global if import in is lambda nonlocal not or pass raise return try while"
    " with yield match case type np sp float ";

constexpr std::string_view kMatlab =
    " break case catch classdef continue else elseif end for function global if otherwise parfor"
    " persistent return spmd switch try while tau pi eps NaN Inf nan inf ans i j beta eye max imag"
    " real isnan sign real_sqrt real_log real_power ";

// Of formulas, and of the code around them.
constexpr std::string_view kOwn = " exp log sqrt abs sgn sin cos tanh atan sign_of ";

bool holds(std::string_view list, std::string_view name) {
  if (name.empty()) return false;  // what has no name; every list begins and ends with a blank
  for (std::size_t at = list.find(name); at != std::string_view::npos;
       at = list.find(name, at + 1)) {
    if (list[at - 1] == ' ' && list[at + name.size()] == ' ') return true;
  }
  return false;
}

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

}  // namespace

bool is_reserved_word(std::string_view name) {
  if (name.empty() || name.front() == '_') return true;
  for (const std::string_view list : {kC, kMath, kPython, kMatlab, kOwn}) {
    if (holds(list, name)) return true;
  }
  // M_PIf, M_1_PIl and their like.
  if (name.starts_with("M_") && name.back() != '_') {
    const bool is_numbered = name.starts_with("M_1_") || name.starts_with("M_2_");
    const std::string_view rest = name.substr(is_numbered ? 4 : 2);
    if (rest.size() > 1 && is_capital(rest.front())) return true;
  }
  return (name.back() == 'f' || name.back() == 'l') &&
         holds(kMath, name.substr(0, name.size() - 1));
}

std::string unreserved(std::string_view name) {
  std::string mended(name);
  if (mended.starts_with('_')) mended.insert(0, 1, 'x');
  while (is_reserved_word(mended)) mended += '_';
  return mended;
}

}  // namespace tribench

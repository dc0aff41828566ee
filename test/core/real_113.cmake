# Whether there is a number of 113 bits for reference_113.h, VWD_HAS_REAL113, and what is to be linked
# for it, VWD_REAL113_LIBRARIES.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#include <cfloat>
  static_assert(LDBL_MANT_DIG == 113, \"\"); int main() { return 0; }" VWD_HAS_LONG_DOUBLE_113)
set(CMAKE_REQUIRED_LIBRARIES quadmath)
check_cxx_source_compiles("#include <quadmath.h>
  int main() { __float128 x = 1; return sinq(x) > x; }" VWD_HAS_QUADMATH)
unset(CMAKE_REQUIRED_LIBRARIES)

set(VWD_HAS_REAL113 FALSE)
set(VWD_REAL113_LIBRARIES)
if(VWD_HAS_LONG_DOUBLE_113)
  set(VWD_HAS_REAL113 TRUE)
elseif(VWD_HAS_QUADMATH)
  set(VWD_HAS_REAL113 TRUE)
  set(VWD_REAL113_LIBRARIES quadmath)
endif()

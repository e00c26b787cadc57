#ifndef GP_EXACT_H
#define GP_EXACT_H
/* No fused products and sums, by whatever compiler and with whatever flags: sources/ give the doubles of the libraries. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif

#endif

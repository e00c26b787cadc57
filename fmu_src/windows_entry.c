/* What the Windows linker expects of a library without the full C runtime (hatch_build.py links ucrtbase only).
   Ordinary compilers bring their own entry, so this is left out unless GP_BARE_WINDOWS is defined. */
#ifdef GP_BARE_WINDOWS
int _fltused = 1;
int __stdcall DllMainCRTStartup(void *library, unsigned long reason, void *reserved);
int __stdcall DllMainCRTStartup(void *library, unsigned long reason, void *reserved) {
    (void)library;
    (void)reason;
    (void)reserved;
    return 1;
}
#else
typedef int gp_not_windows; /* ISO C wants something in every file */
#endif

// The packaged library is not built for ThreadSanitizer, which therefore cannot see that its
// function-local statics are guarded. Only what the library itself touches is left out.
#if defined(__SANITIZE_THREAD__)
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libcpp-httplib.so\n";
}
#endif

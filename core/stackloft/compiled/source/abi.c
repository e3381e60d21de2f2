/* Which sources this library was compiled from; building.py gives the number on the command line. */

int stackloft_abi(void);

int stackloft_abi(void)
{
    return STACKLOFT_ABI;
}

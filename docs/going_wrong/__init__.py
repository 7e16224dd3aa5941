"""Cases of the page "What can go wrong": each draws its picture and gives the words of a real run."""

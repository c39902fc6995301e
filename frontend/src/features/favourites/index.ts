export { FavouritesBox } from './favourites-box';
